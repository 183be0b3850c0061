// SPDX-License-Identifier: Apache-2.0
// `run` of a recording with several cameras: each is judged by a pipeline of its own.
#include <algorithm>
#include <atomic>
#include <exception>
#include <iostream>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <io/files/camera_views.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/pending_file.hpp>
#include <io/run/output_bag.hpp>
#include <io/web/camera_views_page.hpp>

namespace penumbra::app {
namespace {

/// One camera's run. Its results stay with its session.
struct CameraTask {
  std::string name;
  RunArguments arguments;
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
  one.output.threads = threads;
  return one;
}

void judge(CameraTask& task, const std::function<bool()>& go_on) {
  task.session.emplace(task.arguments.session, [](const std::string&) {});
  const auto output = open_output(task.arguments.output, *task.session);
  io::ViewRecorder recorder(task.name, task.session->pipeline(), *output);
  recorder.begin(task.session->head());
  task.result = task.session->run(recorder, go_on);
  task.views = recorder.run();
}

/// Judges the cameras, `workers` at a time. Throws the first camera's fault.
void judge_all(std::vector<CameraTask>& tasks, std::size_t workers,
               const std::function<bool()>& go_on) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> has_fault = false;
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) try {
        judge(tasks[i], [&] { return go_on() && !has_fault; });
      } catch (const InputError& error) {
        tasks[i].fault =
            std::make_exception_ptr(InputError("camera '" + tasks[i].name + "': " + error.what()));
        has_fault = true;
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

/// Removes what an earlier run says over all cameras, as this run may fail.
void remove_former(const std::filesystem::path& out) {
  std::error_code error;
  const std::filesystem::path views = out / "views.json";
  if (std::filesystem::remove(views, error)) std::filesystem::remove(out / "report.html", error);
  if (error)
    throw InputError(views.string() + ": of an earlier run, cannot be removed (" + error.message() +
                     "); choose another folder with -o");
}

void write(const std::filesystem::path& file, const std::string& text) {
  io::PendingFile pending(file);
  io::write_file(pending.part(), text.data(), text.size());
  pending.finish();
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
  std::vector<CameraTask> tasks;
  for (const NamedCamera& camera : cameras) {
    tasks.push_back(
        {.name = camera.name, .arguments = arguments_of(arguments, camera, threads / workers)});
    io::check_output_folder(tasks.back().arguments.output);
  }
  remove_former(out);
  catch_interrupts();
  judge_all(tasks, static_cast<std::size_t>(workers), [] { return !was_interrupted(); });

  std::vector<io::CameraRun> runs;
  int status = 0;
  for (CameraTask& task : tasks) {
    std::cout << "camera " << task.name << ":\n";
    print_result(task.result, task.session->pipeline().robot(),
                 "report: " + (task.arguments.output.path / "report.json").string());
    status = std::max(status, status_of(task.result, arguments.output.force));
    runs.push_back(std::move(*task.views));
  }
  const io::CameraViews views = io::fuse_views(arguments.session.input.path.string(), runs);
  print_counts(io::counts_of(views), cameras.size());
  write(out / "views.json", io::views_json(views));
  if (arguments.output.report_page) write(out / "report.html", io::camera_views_page(views));
  std::cout << "all cameras: " << (out / "views.json").string() << '\n';
  return status;
}

}  // namespace penumbra::app
