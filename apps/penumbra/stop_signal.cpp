// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>

#include <apps/penumbra/stop_signal.hpp>

namespace penumbra::app {

using namespace std::chrono;

StopSignal::StopSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

bool StopSignal::wait(nanoseconds at_most) { return wait_until(steady_clock::now() + at_most); }

bool StopSignal::wait_until(steady_clock::time_point end) {
  while (!came_) {
    const nanoseconds left = std::max<nanoseconds>(end - steady_clock::now(), nanoseconds(0));
    const auto whole = duration_cast<std::chrono::seconds>(left);
    const timespec longest{whole.count(), (left - whole).count()};
    came_ = sigtimedwait(&signals_, nullptr, &longest) > 0;
    if (!came_ && errno != EINTR) break;
  }
  return came_;
}

}  // namespace penumbra::app
