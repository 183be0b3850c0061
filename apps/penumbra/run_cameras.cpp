// SPDX-License-Identifier: Apache-2.0
// `run` of a recording with several cameras: each is judged by a pipeline of its own.
#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <io/files/camera_views.hpp>
#include <io/files/names.hpp>
#include <io/outputs/output_folder.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::app {
namespace {

/// One camera's run. Its results stay with its session.
struct CameraTask {
  std::string name;
  RunArguments arguments;
  std::unique_ptr<io::ResultFolder> folder;
  std::optional<io::InputSession> session = {};
  std::optional<io::CameraRun> views = {};
  io::RunResult result = {};
  std::exception_ptr fault = {};
};

RunArguments arguments_of(const RunArguments& all, const NamedCamera& camera, int threads) {
  RunArguments one = all;
  io::InputOptions& input = one.session.input;
  if (camera.depth_topic.empty()) {
    input.camera = camera.name;
  } else {
    input.bag.depth_topic = camera.depth_topic;
    input.bag_option = "--camera NAME=TOPIC";
  }
  one.session.renderer.threads = 1;
  one.output.path = all.output.path / camera.name;
  one.output.threads = input.threads = threads;
  return one;
}

void open(CameraTask& task) {
  task.session.emplace(task.arguments.session, [](const std::string&) {});
}

void judge(CameraTask& task, const std::function<bool()>& go_on) {
  const Pipeline& pipeline = task.session->pipeline();
  const auto output = open_output(task.arguments.output, *task.folder, pipeline);
  io::ViewRecorder recorder(task.name, pipeline);
  task.result = task.session->run({&recorder, output.get()}, go_on);
  task.views = recorder.run();
}

/// Thrown where a camera's work ends because another one failed: it leaves no results.
struct Stopped {};

/// Works on the cameras, `workers` at a time, until one fails. Throws the first camera's fault.
void for_all(std::vector<CameraTask>& tasks, std::size_t workers,
             const std::function<void(CameraTask&, const std::atomic<bool>& has_fault)>& work_on) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> has_fault = false;
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size() && !has_fault; i = next++) try {
        work_on(tasks[i], has_fault);
      } catch (const InputError& error) {
        tasks[i].fault =
            std::make_exception_ptr(InputError("camera '" + tasks[i].name + "': " + error.what()));
        has_fault = true;
      } catch (const Stopped&) {  // NOLINT(bugprone-empty-catch): the other's fault is reported
      } catch (...) {
        tasks[i].fault = std::current_exception();
        has_fault = true;
      }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < workers; ++i) threads.emplace_back(work);
  threads.clear();
  for (const CameraTask& task : tasks)
    if (task.fault) std::rethrow_exception(task.fault);
}

void print_counts(const std::vector<io::FusedCounts>& targets, std::size_t cameras) {
  for (const io::FusedCounts& target : targets)
    std::cout << "target " << target.name << " over " << cameras
              << " cameras: " << target.times(Verdict::visible) << " visible, "
              << target.times(Verdict::partial) << " partial, " << target.times(Verdict::hidden)
              << " hidden, " << target.times(Verdict::unknown) << " unknown, "
              << target.times(Verdict::out_of_view) << " out of view, "
              << target.times(Verdict::held) << " held; " << target.contradictions
              << " contradictions\n";
}

/// What OUT holds besides the cameras' folders.
io::ResultFolderOptions results_of(const io::OutputOptions& output,
                                   const std::vector<NamedCamera>& cameras) {
  io::ResultFolderOptions results = io::run_results(output);
  results.report.name = "views.json";
  for (const NamedCamera& camera : cameras) results.subfolders.push_back(camera.name);
  return results;
}

}  // namespace

int run_cameras(const RunArguments& arguments, const std::vector<NamedCamera>& cameras) {
  const std::filesystem::path& out = arguments.output.path;
  if (io::is_output_bag(out))
    throw InputError("--output: " + out.string() +
                     " is a bag, which takes one camera's results; choose a folder, or a camera "
                     "by --camera");
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = arguments.output.threads > 0 ? arguments.output.threads : cores;
  const int workers = std::min(threads, static_cast<int>(cameras.size()));
  io::ResultFolder folder(results_of(arguments.output, cameras));
  std::vector<CameraTask> tasks;
  for (const NamedCamera& camera : cameras) {
    const RunArguments own = arguments_of(arguments, camera, threads / workers);
    tasks.push_back({.name = camera.name,
                     .arguments = own,
                     .folder = std::make_unique<io::ResultFolder>(io::run_results(own.output))});
  }
  for_all(tasks, static_cast<std::size_t>(workers),
          [](CameraTask& task, const auto& /*has_fault*/) { open(task); });
  folder.begin();
  catch_interrupts();
  for_all(tasks, static_cast<std::size_t>(workers), [](CameraTask& task, const auto& has_fault) {
    judge(task, [&] {
      if (has_fault) throw Stopped();
      return !was_interrupted();
    });
  });

  std::vector<io::CameraRun> runs;
  int status = 0;
  for (CameraTask& task : tasks) {
    std::cout << "camera " << task.name << ":\n";
    print_result(task.result, task.session->pipeline().robot(),
                 "report: " + (task.arguments.output.path / "report.json").string());
    status = std::max(status, status_of(task.result, arguments.output.force));
    runs.push_back(std::move(*task.views));
  }
  const io::CameraViews views = io::fuse_views(io::input_name(arguments.session.input.path), runs);
  print_counts(io::counts_of(views), cameras.size());
  const std::string json = io::views_json(views);
  if (arguments.output.report_page) folder.add_text("report.html", io::report_page(json));
  folder.add_text("views.json", json);
  folder.finish();
  std::cout << "all cameras: " << (out / "views.json").string() << '\n';
  return status;
}

}  // namespace penumbra::app
