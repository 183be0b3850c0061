// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <string>

#include <unistd.h>

#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

constexpr std::size_t bar_width = 30;  // characters
constexpr std::chrono::milliseconds draw_interval{100};

}  // namespace

Progress::Progress(std::size_t total)
    : total_(total),
      visible_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      next_draw_(start_) {}

Progress::~Progress() {
  if (visible_) std::cerr << "\r\033[K" << std::flush;
}

void Progress::step() {
  ++done_;
  if (!visible_) return;
  const auto now = Clock::now();
  if (now < next_draw_ && done_ < total_) return;
  next_draw_ = now + draw_interval;
  draw(now);
}

void Progress::draw(Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::cerr << '\r';
  if (total_ > 0) {
    const std::size_t filled = bar_width * std::min(done_, total_) / total_;
    std::cerr << '[' << std::string(filled, '#') << std::string(bar_width - filled, '.') << "] ";
  }
  const double rate = seconds > 0.0 ? static_cast<double>(done_) / seconds : 0.0;
  std::cerr << done_ << (total_ > 0 ? "/" + std::to_string(total_) : "") << " frames, "
            << fixed(rate, 1) << "/s";
  if (total_ > done_ && rate > 0.0)
    std::cerr << ", " << fixed(static_cast<double>(total_ - done_) / rate, 0) << " s left";
  std::cerr << "\033[K" << std::flush;
}

}  // namespace penumbra::app
