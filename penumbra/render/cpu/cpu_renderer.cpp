// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/workers.hpp>
#include <penumbra/render/backends-inl.hpp>
#include <penumbra/render/clusters.hpp>
#include <penumbra/render/cpu/frame.hpp>
#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/triangle_groups.hpp>

namespace penumbra {
namespace {

using cpu::BodyFrame;
using cpu::Canvas;
using cpu::DrawItem;

/// The bodies' numbers in the canvas's words, which are index + 1 unless there are more bodies than
/// the words have room for: then only bodies with triangles have numbers.
struct BodyNumbers {
  explicit BodyNumbers(std::span<const Body> bodies) : largest(bodies.size()) {
    if (bodies.size() <= DepthRenderer::max_drawn_bodies) {
      of_body.resize(bodies.size());
      std::iota(of_body.begin(), of_body.end(), 1);
      return;
    }
    links.push_back(0);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const bool drawn = bodies[i].triangle_count() > 0;
      of_body.push_back(drawn ? static_cast<std::int32_t>(links.size()) : 0);
      if (drawn) links.push_back(static_cast<std::uint16_t>(i + 1));
    }
    largest = links.size() - 1;
  }

  std::size_t largest;
  std::vector<std::int32_t> of_body;
  std::vector<std::uint16_t> links;  // of a number: body index + 1; empty where that is the number
};

class CpuRenderer final : public DepthRenderer {
 public:
  CpuRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies, int threads,
              std::int64_t target)
      : DepthRenderer(
            intrinsics, bodies,
            {.backend = Backend::cpu, .isa = simd_target_name(target), .threads = threads}),
        kernel_(cpu::kernel_for(target)),
        scene_(shared_scene(bodies)),
        view_(intrinsics),
        side_rule_(intrinsics),
        numbers_(bodies),
        packing_(numbers_.largest),
        touched_(intrinsics.width(), intrinsics.height()),
        holes_(scene_->holes.size()),
        order_(scene_->groups.size()),
        items_(scene_->clusters.size()),
        workers_(threads) {
    for (int i = 0; i < threads; ++i) {
      canvases_.emplace_back(intrinsics, kernel_.lanes);
      scratch_.push_back(cpu::make_scratch());
    }
    stride_ = static_cast<std::size_t>(canvases_[0].blocks_per_row) * cpu::block_width;
    depth_.resize(stride_ * touched_.rows.size() * TileMask::tile_height);
    links_.resize(depth_.size());
    frames_.reserve(bodies.size());
  }

 private:
  void do_submit(std::span<const Eigen::Isometry3d> T_camera_body,
                 const PixelRectangle& window) override {
    view_.look_at(window);
    frames_.clear();
    for (const Eigen::Isometry3d& T : T_camera_body) {
      frames_.emplace_back(T, intrinsics(), numbers_.of_body[frames_.size()]);
    }
    cull();
    run<&CpuRenderer::draw>(item_count_);
    run<&CpuRenderer::resolve>(touched_.rows.size());
  }

  VirtualDepthView do_collect() override {
    const int width = intrinsics().width();
    const int height = intrinsics().height();
    const auto stride = static_cast<std::ptrdiff_t>(stride_);
    return {
        {depth_.data(), width, height, stride}, {links_.data(), width, height, stride}, &touched_};
  }

  [[nodiscard]] cpu::FrameContext context() const {
    return {scene_.get(), frames_.data(), holes_.data(), &view_, packing_};
  }

  /// Lists the clusters to draw, those of the nearest groups first.
  void cull() {
    for (std::uint32_t i = 0; i < scene_->groups.size(); ++i) {
      const ClusterGroup& group = scene_->groups[i];
      const BodyFrame& body = frames_[group.body];
      for (std::size_t hole = group.first_hole; hole < group.first_hole + group.hole_count; ++hole)
        holes_[hole] = cpu::bounds_of(scene_->holes[hole], body, intrinsics());
      const Eigen::Vector3d middle = body.T_camera_body * group.bounds.center();
      order_[i] = {middle.z() - group.bounds.diagonal().norm() / 2.0, i};
    }
    std::sort(order_.begin(), order_.end());
    item_count_ = 0;
    for (const auto& [nearest, i] : order_) {
      const Sides sides = sides_of(scene_->groups[i]);
      for (const bool second : {false, true})
        if (!second || sides == Sides::both)
          item_count_ += kernel_.cull(context(), i, sides, second, &items_[item_count_]);
    }
  }

  [[nodiscard]] Sides sides_of(const ClusterGroup& group) const {
    const auto& c = frames_[group.body].centre;
    return side_rule_.sides(group.solid, group.hole_count > 0, group.bounds, {c[0], c[1], c[2]});
  }

  /// Lets the team take `count` parts of a stage, a few at a time.
  template <void (CpuRenderer::*Stage)(int worker)>
  void run(std::size_t count) {
    next_ = 0;
    part_count_ = count;
    workers_.run([](void* self, int worker) { (static_cast<CpuRenderer*>(self)->*Stage)(worker); },
                 this);
  }

  [[nodiscard]] std::pair<std::size_t, std::size_t> take(std::size_t most) {
    const std::size_t begin = std::min(next_.fetch_add(most), part_count_);
    return {begin, std::min(begin + most, part_count_)};
  }

  void draw(int worker) {
    const auto i = static_cast<std::size_t>(worker);
    const std::size_t most = info().threads == 1 ? part_count_ : 16;
    for (auto [begin, end] = take(most); begin < end; std::tie(begin, end) = take(most)) {
      kernel_.draw(context(), std::span(items_).subspan(begin, end - begin), *scratch_[i],
                   canvases_[i]);
    }
  }

  void resolve(int /*worker*/) {
    const cpu::Output output{depth_.data(), links_.data(), stride_};
    constexpr std::size_t most = 8;
    for (auto [begin, end] = take(most); begin < end; std::tie(begin, end) = take(most)) {
      for (std::size_t row = begin; row < end; ++row) {
        touched_.rows[row] = kernel_.resolve(canvases_, packing_, touched_.rows[row], row, output);
        if (!numbers_.links.empty()) name_links(row);
      }
    }
  }

  /// Replaces the bodies' numbers in a row of tiles.
  void name_links(std::size_t row) {
    const auto width = static_cast<std::size_t>(touched_.tile_width);
    for (std::uint64_t bits = touched_.rows[row]; bits != 0; bits &= bits - 1) {
      const std::size_t u = static_cast<std::size_t>(std::countr_zero(bits)) * width;
      for (std::size_t v = row * TileMask::tile_height; v < (row + 1) * TileMask::tile_height;
           ++v) {
        std::uint16_t* const links = &links_[v * stride_ + u];
        std::transform(links, links + width, links,
                       [this](std::uint16_t number) { return numbers_.links[number]; });
      }
    }
  }

  cpu::Kernel kernel_;
  std::shared_ptr<const ClusteredScene> scene_;
  cpu::View view_;
  SideRule side_rule_;
  BodyNumbers numbers_;
  cpu::Packing packing_;
  TileMask touched_;
  std::vector<BodyFrame> frames_;
  std::vector<cpu::Bounds> holes_;                       // of the scene's
  std::vector<std::pair<double, std::uint32_t>> order_;  // of the scene's groups, the nearest first
  std::vector<DrawItem> items_;
  std::size_t item_count_ = 0;
  std::vector<Canvas> canvases_;          // one per thread
  std::vector<cpu::ScratchPtr> scratch_;  // one per thread
  cpu::AlignedVector<float> depth_;
  cpu::AlignedVector<std::uint16_t> links_;
  std::size_t stride_ = 0;
  std::atomic<std::size_t> next_{0};
  std::size_t part_count_ = 0;
  Workers workers_;  // last: its threads use all of the above
};

}  // namespace

std::unique_ptr<DepthRenderer> make_cpu_renderer(const Intrinsics& intrinsics,
                                                 std::span<const Body> bodies,
                                                 const RendererOptions& options) {
  if (options.threads < 1 || options.threads > RendererOptions::max_threads) {
    throw InputError("threads is " + std::to_string(options.threads) + "; it must be 1 to " +
                     std::to_string(RendererOptions::max_threads));
  }
  return std::make_unique<CpuRenderer>(intrinsics, bodies, options.threads,
                                       simd_target(options.isa));
}

}  // namespace penumbra
