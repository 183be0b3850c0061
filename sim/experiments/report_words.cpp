// SPDX-License-Identifier: Apache-2.0
#include <sim/experiments/report_words.hpp>

namespace penumbra::sim {
namespace {

constexpr const char* left_out =
    "A network trained to complete what is hidden (Luo 2021) is left out: it needs a data set of "
    "its own for each kind of target, and a figure without it would say nothing.";

ReportWords conveyor_words() {
  return {
      .title = "Experiment 1: conveyor pick",
      .story =
          "A textured object moves on a conveyor while a robot arm sweeps over it. A pose "
          "estimator (SIFT features, PnP with RANSAC) follows it in the colour image. What "
          "is believed of the object's pose while the arm hides it, and at the moment of "
          "grasp?",
      .goal = "grasp",
      .limits =
          std::string(
              "Most of the gain is the tracker's, which is part of Penumbra: it was given to "
              "every method whose idea allows one. Without it (no handling; height threshold, "
              "silhouette subtraction and URDF filter as they are) the last estimate grows old "
              "while the belt moves on. The object's own model and the second camera work from a "
              "tracked pose: they have no other form.\n"
              "Here the robot stands before the belt only, so that silhouette subtraction and "
              "URDF filter take away nearly the same.\n"
              "SIFT features are not found on the arm, so that RANSAC is robust to it by itself. "
              "With a careful estimator (ten inliers at least, a covariance) every method with a "
              "tracker is alike, and one that goes on estimating from what is still seen can be "
              "a little better than Penumbra, which predicts from 5 % hidden on. Whoever has "
              "such an estimator lets the tracker take partial verdicts: 'Penumbra, partial'.\n"
              "Errors count frames with a known pose only: read them beside the time without one.\n"
              "With an eager estimator (any four matches that agree, no covariance) the verdict "
              "is what keeps wrong poses out.\n"
              "A pose that is off although nothing hides the object is the estimator's own "
              "fault; no verdict refuses it, and the tracker's gate only if it is far off.\n"
              "Prediction is as good as the motion model: the belt's direction is known, its "
              "speed wanders by 2 %. After seconds of hiding, or on a belt that stops, it is "
              "wrong, and says so by its growing covariance.\n"
              "The height threshold and the second camera are given the exact height of belt and "
              "object; the object's own model is given its exact size.\n"
              "Simulated images without motion blur, a simulated detector, one flat textured "
              "object: the figures tell methods apart; they do not foretell those of another "
              "cell.\n") +
          left_out};
}

ReportWords handover_words() {
  return {
      .title = "Experiment 2: handover",
      .story =
          "A person's hand moves while a robot arm passes between it and the camera, and at "
          "times the hand is in front of the arm. A pose network's key point is right even where "
          "the arm hides the wrist; the depth behind it is not. Which positions are believed?",
      .goal = "end",
      .limits =
          std::string(
              "While the wrist is hidden nobody measures it: methods that hold its last position "
              "are "
              "wrong by what it moved meanwhile, all alike. What tells them apart is what they "
              "believe instead, and what they throw away.\n"
              "Silhouette subtraction refuses every key point on the robot's silhouette, a hand "
              "before the arm too. The URDF filter looks at the depth and keeps that hand, and of "
              "depths nearer than 5 cm before the robot nothing. Here, with our tracker, it is "
              "nearly as good as Penumbra, which refuses a few visible hands by its verdict or for "
              "want of trusted depths.\n"
              "'On the robot's body': the surface that was measured lies within 3 cm of the "
              "robot's "
              "true surface and nearer to it than to the wrist's true one, however far off the "
              "position is. A position measured elsewhere, and wrong, counts as off by > 10 cm "
              "only.\n"
              "Errors count frames with a known position only: read them beside the time without "
              "one.\n"
              "A second camera that sees the wrist from the other side goes on measuring it, and "
              "is "
              "better than anything that holds. It works from the held position, as the hand's own "
              "model does: both fail where the hand moves further than they allow for, and at the "
              "start.\n"
              "The height threshold is given the wrist's true height at every instant, which no "
              "real "
              "system knows.\n"
              "Penumbra holds from 5 % hidden on, although part of the key point may still be "
              "measured; 'Penumbra, partial' uses that part.\n"
              "Errors while the hand moves are mostly latency (50 to 300 ms): a held position does "
              "not predict. Key points are simulated, with noise but without gross errors.\n") +
          left_out};
}

}  // namespace

const ReportWords& report_words(const std::string& experiment) {
  static const ReportWords conveyor = conveyor_words(), handover = handover_words();
  return experiment == "conveyor" ? conveyor : handover;
}

}  // namespace penumbra::sim
