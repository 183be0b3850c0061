// SPDX-License-Identifier: Apache-2.0
// A detector's files.
#include "files.hpp"
#include "robots.hpp"

#include <numeric>

#include <io/files/detections_file.hpp>
#include <io/files/targets_file.hpp>

namespace penumbra::io {
namespace {

using test::expect_refused;

class DetectionsTest : public testing::Test {
 protected:
  [[nodiscard]] Detections read(const std::string& name) const {
    return read_detections(name, folder_.path(), images(), {{39, "bottle"}},
                           usual_first_frame(name));
  }
  [[nodiscard]] Detections read(const std::string& name, const std::string& text) const {
    folder_.write(name, text);
    return read(name);
  }
  static Intrinsics images() { return {70, 50, 100, 100, 35, 25}; }
  [[nodiscard]] TargetsFile open(const std::string& name) const {
    return TargetsFile::open(folder_.path() / name, {.robot = robot_,
                                                     .image = ImageSpace::raw,
                                                     .images = images(),
                                                     .has_distortion = false,
                                                     .beyond_hides = true});
  }
  /// A box in frame 4 whose left upper corner is that of the pixel (10, 20).
  static void expect_the_bottle(const Detections& found, const std::string& track) {
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found.at(4).size(), 1U);
    const Detection& bottle = found.at(4).front();
    EXPECT_EQ(bottle.category, "bottle");
    EXPECT_EQ(bottle.track, track);
    EXPECT_EQ(bottle.score, 0.75);
    const auto& box = std::get<PixelBox>(bottle.region);
    EXPECT_NEAR(box.u, 9.5, 1e-9);
    EXPECT_NEAR(box.v, 19.5, 1e-9);
    EXPECT_NEAR(box.width, 14, 1e-9);
    EXPECT_NEAR(box.height, 15, 1e-9);
  }

  test::TemporaryFolder folder_;
  Robot robot_ = test::bare_robot();
};

TEST_F(DetectionsTest, EveryFormatGivesTheSameBox) {
  expect_the_bottle(
      read("a.json",
           R"([{"image_id": 4, "category_id": 39, "bbox": [10, 20, 14, 15], "score": 0.75}])"),
      "");
  expect_the_bottle(read("b.json", R"({"images": [{"id": 900, "file_name": "rgb/frame_000004.png"}],
                         "categories": [{"id": 1, "name": "bottle"}],
                         "annotations": [{"image_id": 900, "category_id": 1, "track_id": 7,
                                          "bbox": [10, 20, 14, 15], "score": 0.75}]})"),
                    "7");
  expect_the_bottle(read("c.csv", "frame,class,track,score,x0,y0,x1,y1\n4,39,7,0.75,10,20,24,35\n"),
                    "7");
  expect_the_bottle(read("d.txt", "5,7,10,20,14,15,0.75,39,1\n"), "7");  // MOT counts from 1
  folder_.write("yolo/000004.txt", "39 0.2428571428571428 0.55 0.2 0.3 0.75 7\n");
  expect_the_bottle(read("yolo/%06d.txt"), "7");
}

/// Made by pycocotools of a mask of 50 x 70 pixels.
TEST_F(DetectionsTest, ReadsCompressedRunLengths) {
  const std::string counts =
      R"(0g05b08J4M2N2NA^O1`0OCO=0E090H080IO68DH;>@C>a0_O_O`0j0OWOF<:CM72I24NL43JM92FN;1E)"
      R"(NKO72L0LO91J0MO92INO0NO122OO0M031O000NO31OO11MO40N011MO41MO21L06OL021L06OL021L06)"
      R"(OL021L060J040L060J040L060J040L060J040L060J040L060J040L060KO31L060KO31L06OL021L06)"
      R"(OL021L06OL021MO41MO21MO40N100NO310O00M0310O00NO1220NO92IONO91KOMO72M0<1EO:2GN63K)"
      R"(M34OLM73JF<;=1G_O_Ob0=AC`07EH=1IO71H090F0:1DO>1_O1b0>2N2N3L6H]O)";
  const Detections found =
      read("a.json", R"([{"image_id": 4, "category_id": 1, "segmentation": {"size": [50, 70],
                          "counts": ")" +
                         counts + R"("}}])");
  const auto& mask = std::get<RunLengthMask>(found.at(4).front().region);
  EXPECT_EQ(std::accumulate(mask.counts.begin(), mask.counts.end(), 0U), 3500U);
  EXPECT_EQ(found.at(4).front().category, "1");
}

TEST_F(DetectionsTest, FaultsNameFileAndLine) {
  const std::string one = R"([{"image_id": 4, "category_id": 1, )";
  for (const auto& [name, text, says] : std::initializer_list<std::array<std::string, 3>>{
           {"a.json", "", "no JSON"},
           {"a.json", "[1]", "detection 0"},
           {"a.json", "[]", "no detection"},
           {"a.json", R"({"version": "5", "shapes": [], "imagePath": "4.png"})", "LabelMe"},
           {"a.json", R"([{"image_id": 4, "category_id": 39}])", "bbox"},
           {"a.json", R"([{"image_id": "left", "category_id": 1, "bbox": [1, 2, 3, 4]}])", "left"},
           {"a.json", one + R"("segmentation": {"size": [9, 9], "counts": "4"}}])", "[50, 70]"},
           {"a.json", one + R"("segmentation": {"size": [50, 70], "counts": "o"}}])",
            "run lengths"},
           {"a.csv", "frame,x0,y0,x1\n", ":1: "},
           {"a.csv", "frame,x0,y0,x1,y1\n1,2,3,4\n", ":2: "},
           {"a.txt", "1,2,3\n", ":1: "},
           {"a.txt", "1,2,3,4,5,6\n1.5,2,3,4,5,6\n", ":2: "},
           {"a.txt", "1,2,3,4,5,x\n", ":1: 'x'"},
           {"a.xml", "", "no detector's file"},
           {"labels/3.txt", "0 100 200 14 15\n", ":1: "}}) {
    folder_.write(name, text);
    expect_refused([&, file = name == "labels/3.txt" ? "labels/%d.txt"
                                                     : name] { static_cast<void>(read(file)); },
                   {name, says});
  }
  expect_refused([&] { return read("none/%d.txt"); }, {"none/%d.txt"});
}

TEST_F(DetectionsTest, ClassesSayHowTheyAreJudged) {
  folder_.write("d.csv",
                "frame,class,track,score,x0,y0,x1,y1\n"
                "0,39,7,0.9,10,20,24,35\n0,39,,0.9,30,20,44,35\n0,39,8,0.2,10,20,24,35\n"
                "0,person,1,0.9,1,2,3,4\n2,cup,3,0.9,1,2,3,4\n");
  folder_.write("t.yaml",
                "detections: d.csv\nnames: {39: bottle}\nclasses:\n"
                "  bottle: {height: 0.25, thickness: 0.07, min_score: 0.5, handling: {point: {}}}\n"
                "  cup:\n");
  TargetsFile file = open("t.yaml");
  const std::vector<Target> targets = file.of_frame(0);
  ASSERT_EQ(targets.size(), 2U) << "no person, and no score of 0.2";
  EXPECT_EQ(targets[0].name, "bottle_7");
  EXPECT_EQ(targets[0].depth_margin, 0.035);
  EXPECT_TRUE(std::holds_alternative<PointTrackerConfig>(targets[0].handling));
  EXPECT_TRUE(targets[0].has_identity);
  EXPECT_FALSE(targets[1].has_identity) << "without a track it may be another one";
  const auto& region = std::get<RegionTarget>(targets[0].shape);
  EXPECT_EQ(region.height, 0.25);
  EXPECT_EQ(region.extent, Extent::modal);
  EXPECT_TRUE(file.of_frame(1).empty());
  EXPECT_EQ(file.of_frame(2).size(), 1U);
  EXPECT_EQ(open("d.csv").of_frame(0).size(), 4U) << "a detector's file alone";

  EXPECT_TRUE(file.notes().empty());
  const std::int64_t others[] = {7};
  expect_refused([&] { file.check_frames(others); }, {"t.yaml", "0 to 2"});
}

TEST_F(DetectionsTest, BoxesOfAnotherImageAreRefused) {
  const auto coco = [](const std::string& size, const std::string& box) {
    return R"({"images": [{"id": 1, "file_name": "4.png")" + size +
           R"(}], "categories": [], "annotations": [{"image_id": 1, "category_id": 1, "bbox": )" +
           box + "}]}";
  };
  EXPECT_EQ(read("a.json", coco(R"(, "width": 70, "height": 50)", "[10, 20, 14, 15]")).size(), 1U);
  EXPECT_EQ(read("a.json", coco("", "[10, 20, 14, 15]")).size(), 1U);
  for (const std::string size :
       {R"(, "width": 140, "height": 100)", R"(, "width": 64, "height": 64)"})
    expect_refused([&] { return read("a.json", coco(size, "[10, 20, 14, 15]")); },
                   {"a.json", "70 x 50"});
  for (const auto& [file, text] : std::initializer_list<std::array<std::string, 2>>{
           {"a.json", coco("", "[0.1, 0.2, 0.14, 0.15]")},
           {"a.csv", "frame,x0,y0,x1,y1\n0,0.1,0.2,0.24,0.35\n1,0.5,0.5,1,1\n"},
           {"a.txt", "1,-1,0.1,0.2,0.14,0.15\n"}})
    expect_refused([&, name = file, content = text] { return read(name, content); },
                   {file, "fractions"});
  std::string named = coco(R"(, "width": 140, "height": 100)", "[10, 20, 14, 15]");
  named.replace(named.find("\"id\": 1"), 7, "\"id\": \"a1\"");
  named.replace(named.find("\"image_id\": 1"), 13, "\"image_id\": \"a1\"");
  expect_refused([&] { return read("a.json", named); }, {"a.json", "70 x 50"});
  // Degenerate boxes of single frames are those frames' matter.
  EXPECT_EQ(read("a.csv", "frame,x0,y0,x1,y1\n0,0,0,0,0\n1,5,5,9,9\n").size(), 2U);
}

TEST_F(DetectionsTest, BoxesOutsideOfTheImageAreNoted) {
  const auto doubt = [&](const std::string& rows) {
    return doubt_of(read("a.csv", "frame,x0,y0,x1,y1\n" + rows), images());
  };
  EXPECT_EQ(doubt("0,10,20,24,35\n1,-9,20,24,35\n"), "") << "partly outside, as amodal boxes are";
  EXPECT_NE(doubt("0,100,20,124,35\n1,10,20,150,90\n").find("2 of 2"), std::string::npos);
  // Corners in place of width and height: [30, 20, 60, 45].
  EXPECT_NE(doubt("0,30,20,90,65\n1,5,5,15,16\n2,6,5,16,17\n").find("x0, y0, x1, y1"),
            std::string::npos);
}

TEST_F(DetectionsTest, AScoreOfMinusOneIsNone) {
  for (const auto& [name, text] : std::initializer_list<std::array<std::string, 2>>{
           {"d.txt", "1,7,10,20,14,15,-1,-1,-1,-1\n"},
           {"d.csv", "frame,track,x0,y0,x1,y1,score\n0,7,10,20,24,35,-1\n"},
           {"d.json",
            R"([{"image_id": 0, "category_id": 1, "bbox": [10, 20, 14, 15], "score": -1,
                 "track_id": null}])"}}) {
    EXPECT_FALSE(read(name, text).at(0).front().score) << name;
    EXPECT_EQ(open(name).of_frame(0).size(), 1U) << name;
  }
  EXPECT_EQ(read("d.json").at(0).front().track, "");
}

TEST_F(DetectionsTest, LeastScoresThatDecideNothingAreNoted) {
  const auto opened = [&](const std::string& scores, const std::string& least) {
    folder_.write("d.csv", "frame,class,x0,y0,x1,y1,score\n" + scores);
    folder_.write("t.yaml", "detections: d.csv\nclasses: {a: {min_score: " + least + "}}\n");
    return open("t.yaml").notes();
  };
  const std::string box = "0,a,10,20,24,35,";
  EXPECT_TRUE(opened(box + "0.9\n" + box + "0.2\n", "0.5").empty());
  EXPECT_TRUE(opened(box + "-3.5\n" + box + "7\n", "2").empty()) << "other scales are right, too";
  EXPECT_EQ(opened(box + "-1\n" + box + "0.9\n", "0.5").size(), 1U);
  EXPECT_EQ(opened(box + "90\n", "0.5").size(), 1U) << "percent";
  EXPECT_EQ(opened(box + "0.3\n", "50").size(), 1U) << "none is left";
}

TEST_F(DetectionsTest, YolosSixthNumberMayBeTheTrack) {
  const auto yolo = [&](const std::string& sixth, const std::string& of_next) {
    folder_.write("labels/0.txt", "0 0.5 0.5 0.2 0.3 " + sixth + "\n");
    folder_.write("labels/1.txt", "0 0.5 0.5 0.2 0.3 " + of_next + "\n");
    return read("labels/%d.txt").at(0).front();
  };
  EXPECT_EQ(yolo("1", "12").track, "1");
  EXPECT_FALSE(yolo("1", "12").score);
  EXPECT_EQ(yolo("1", "0.9").track, "") << "a score";
  EXPECT_EQ(yolo("1", "0.9").score, 1.0);
}

TEST_F(DetectionsTest, FramesNumberedFromAnotherAreNamed) {
  const auto opened = [&](const std::string& name) {
    TargetsFile file = open(name);
    file.check_frames(std::array<std::int64_t, 4>{0, 1, 2, 3});
    return file;
  };
  const auto boxes = [&](const std::vector<int>& numbers) {
    std::string rows = "frame,x0,y0,x1,y1\n";
    for (const int number : numbers) rows += std::to_string(number) + ",10,20,24,35\n";
    folder_.write("d.csv", rows);
  };
  folder_.write("t.yaml", "detections: d.csv\nfirst_frame: 1\n");
  boxes({1, 2, 3, 4});
  expect_refused([&] { opened("d.csv"); }, {"d.csv", "1 to 4", "first_frame: 1"});
  TargetsFile moved = opened("t.yaml");
  EXPECT_TRUE(moved.notes().empty());
  EXPECT_EQ(moved.of_frame(0).size(), 1U);
  boxes({0, 1, 7});
  EXPECT_EQ(opened("d.csv").notes().size(), 1U) << "frame 7 does not exist";
  boxes({1, 2, 3});
  EXPECT_TRUE(opened("d.csv").notes().empty()) << "nothing was found in frame 0";
  folder_.write("d.txt", "0,1,10,20,14,15\n1,1,10,20,14,15\n");
  expect_refused([&] { return open("d.txt"); }, {"d.txt", "first_frame: 0"});
  folder_.write("d.txt", "2,1,10,20,14,15\n5,1,10,20,14,15\n");
  expect_refused([&] { opened("d.txt"); }, {"first_frame: 2"});
}

TEST_F(DetectionsTest, ATrackTwiceInAFrameAndTooManyBoxesAreRefused) {
  const std::string header = "frame,track,x0,y0,x1,y1\n";
  expect_refused([&] { return read("a.csv", header + "3,7,1,2,9,9\n3,7,20,2,29,9\n"); },
                 {"a.csv", "frame 3", "7"});
  EXPECT_EQ(read("a.csv", header + "3,-1,1,2,9,9\n3,-1,20,2,29,9\n").at(3).size(), 2U);
  std::string many = header;
  for (int i = 0; i < 5000; ++i) many += "3,,1,2,9,9\n";
  expect_refused([&] { return read("a.csv", many); }, {"a.csv", "frame 3", "5000"});
}

TEST_F(DetectionsTest, WrongClassesNameTheirLine) {
  folder_.write("d.csv", "frame,x0,y0,x1,y1\n0,1,2,3,4\n");
  const auto refused = [&](const std::string& text, const std::string& says) {
    folder_.write("t.yaml", text);
    expect_refused([&] { return open("t.yaml"); }, {"t.yaml:" + says});
  };
  refused("detections: none.csv\n", "1: detections: ");
  refused("detections: d.csv\nclasses: {a: {heigth: 1}}\n", "2: classes.a.heigth");
  refused("detections: d.csv\nclasses: {a: {height: 0}}\n", "2: classes.a.height");
  refused("detections: d.csv\nclasses: {a: {handling: pose}}\n", "2: classes.a.handling");
  refused("detections: d.csv\nnames: {a: b}\n", "2: names.a");
  refused("detections: d.csv\nclasses: {cup: {}}\n", "1: detections: ");
  refused("targets: []\nclasses: {}\n", "2: classes");
}

}  // namespace
}  // namespace penumbra::io
