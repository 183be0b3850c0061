// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {
namespace {

constexpr int most_rounds = 40;
constexpr Reach first_reach{.depth = 0.10, .pixels = 40.0};
constexpr Reach last_reach{.depth = 0.03, .pixels = 12.0};
constexpr double narrowing = 0.8;                        // of the reach, per round
constexpr double small_turn = 2e-6, small_shift = 2e-6;  // rad and metres: converged

constexpr std::array<double, kinds> least_sigma{0.0005, 0.5, 0.5};  // metres, pixels, pixels
/// Depth is counted in millimetres, edges in pixels. A flat surface or a straight edge is off by a
/// part of a step as a whole, which its own residuals do not show: 1 / sqrt(12) along the image's
/// axes, less where it is oblique.
constexpr double rounding = 0.15;  // steps, standard deviation
constexpr std::array<double, kinds> rounded{0.001 * rounding, rounding, rounding};
constexpr double same_view = 0.03;  // metres that a link moves in the camera, at most

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// What is wrong together, by frame, then link: a view of a link, which its mesh, its joint and the
/// sensor's error there put out of place, and every later frame with the same view.
std::vector<std::size_t> views_of(const Model& model, std::span<const KeptFrame* const> frames) {
  const std::size_t links = model.robot().links().size();
  std::vector<std::vector<Eigen::Isometry3d>> poses;
  std::vector<std::size_t> views;
  const State anywhere{.T_parent_camera = Eigen::Isometry3d::Identity(), .joint_offsets = {}};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    poses.push_back(model.T_camera_link(*frames[k], anywhere));
    for (std::size_t link = 0; link < links; ++link) {
      std::size_t first = 0;
      while (pose_difference(poses[first][link], poses[k][link]) > same_view) ++first;
      views.push_back(first * links + link);
    }
  }
  return views;
}

std::array<double, kinds> sigmas_of(const Residuals& residuals) {
  std::array<std::vector<double>, kinds> sizes;
  for (const Residual& residual : residuals.list)
    sizes[static_cast<std::size_t>(residual.kind)].push_back(std::abs(residual.value));
  std::array<double, kinds> sigmas = least_sigma;
  for (std::size_t k = 0; k < kinds; ++k)
    sigmas[k] = std::max(sigmas[k], detail::robust_sigma(sizes[k]));
  return sigmas;
}

/// Huber's weight: large residuals count by their size, so that the sum is about the area between
/// the two borders.
double huber(double residual_in_sigmas) {
  return 1.0 / std::max(1.0, std::abs(residual_in_sigmas));
}

/// The residuals of a kind and a view.
struct Sum {
  double count = 0.0, sum = 0.0, squares = 0.0;  // of weighted residuals
};

/// Returns the correlation of a kind's residuals within a view: independent ones have sums whose
/// variance is that of their parts.
double correlation(const std::vector<std::array<Sum, kinds>>& sums, std::size_t kind) {
  double together = 0.0, alone = 0.0, counts = 0.0, pairs = 0.0;
  for (const auto& view : sums) {
    const Sum& sum = view[kind];
    together += sum.sum * sum.sum;
    alone += sum.squares;
    counts += sum.count;
    pairs += sum.count * (sum.count - 1.0);
  }
  if (!(alone > 0.0) || !(pairs > 0.0)) return 0.0;
  return std::clamp((together / alone - 1.0) * counts / pairs, 0.0, 1.0);
}

/// Weighs residuals as generalised least squares does where those of a view are correlated: many
/// in one view count little more than a few.
Equations equations_of(const Residuals& residuals, const Unknowns& unknowns, const State& state,
                       const std::vector<std::size_t>& views, std::size_t links) {
  const int size = unknowns.size();
  const std::array<double, kinds> sigmas = sigmas_of(residuals);
  std::vector<std::array<Sum, kinds>> sums(views.size());
  std::vector<double> weights(residuals.list.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Residual& residual = residuals.list[i];
    const auto k = static_cast<std::size_t>(residual.kind);
    const double in_sigmas = residual.value / sigmas[k];
    const double weight = residual.kind == Kind::mask
                              ? huber(in_sigmas)
                              : detail::tukey_weight(in_sigmas, detail::tukey_width);
    weights[i] = weight / (sigmas[k] * sigmas[k]);
    Sum& sum = sums[views[residual.frame * links + residual.link]][k];
    sum.count += weight;
    sum.sum += weight * in_sigmas;
    sum.squares += weight * in_sigmas * weight * in_sigmas;
  }
  std::array<double, kinds> correlations{};
  for (std::size_t k = 0; k < kinds; ++k) correlations[k] = correlation(sums, k);

  Equations all{.parts = std::vector<Part>(views.size()),
                .views = views,
                .links = links,
                .information = {},
                .gradient = {},
                .prior = unknowns.prior_sigmas().array().square().inverse().matrix()};
  all.information = all.prior.asDiagonal();
  all.gradient = all.prior.cwiseProduct(unknowns.values(state));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const Residual& residual = residuals.list[i];
    const auto k = static_cast<std::size_t>(residual.kind);
    const double count = sums[views[residual.frame * links + residual.link]][k].count;
    const double weight = weights[i] / (1.0 + std::max(0.0, count - 1.0) * correlations[k]);
    const Eigen::Map<const Vector> row(residuals.rows.data() + i * static_cast<std::size_t>(size),
                                       size);
    Part& part = all.parts[residual.frame * links + residual.link];
    if (part.information.size() == 0)
      part = {Matrix::Zero(size, size), Vector::Zero(size), Matrix::Zero(size, kinds)};
    part.information.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    part.gradient += weight * residual.value * row;
    const double step = residual.kind == Kind::surface ? 1.0 : unknowns.edge_step;
    part.steps.col(static_cast<Eigen::Index>(k)) += weight * step * rounded[k] * row;
  }
  for (Part& part : all.parts) {
    if (part.information.size() == 0) continue;
    part.information = part.information.selfadjointView<Eigen::Lower>();
    all.information += part.information;
    all.gradient += part.gradient;
  }
  return all;
}

/// The sums of the parts of each frame, or of each link, that is seen.
std::vector<Part> sums_of(const Equations& equations, bool by_frame) {
  std::vector<Part> sums(by_frame ? equations.parts.size() / equations.links : equations.links);
  for (std::size_t i = 0; i < equations.parts.size(); ++i) {
    const Part& part = equations.parts[i];
    Part& sum = sums[by_frame ? i / equations.links : i % equations.links];
    if (part.information.size() == 0) continue;
    if (sum.information.size() == 0)
      sum = part;
    else
      sum += part;
  }
  std::erase_if(sums, [](const Part& sum) { return sum.information.size() == 0; });
  return sums;
}

/// The gradient of a group that is larger by what the solution gave way to it: its residuals are
/// smaller than its errors, the more so the more of the result it carries (CR2; Bell and McCaffrey
/// 2002). `inverse`: of all information.
Vector unleveraged(const Part& group, const Matrix& inverse) {
  constexpr double seen = 1e-9;     // of the largest principal value
  constexpr double carried = 1e-3;  // a group that carries a direction alone shows no error there
  const dense::PrincipalAxes axes = dense::principal_axes(group.information);
  const Vector widths =
      axes.values.cwiseMax(seen * axes.values[axes.values.size() - 1]).cwiseSqrt();
  const Matrix factor = axes.vectors * widths.asDiagonal();
  const Matrix rest =
      Matrix::Identity(inverse.rows(), inverse.cols()) - factor.transpose() * inverse * factor;
  const dense::PrincipalAxes left = dense::principal_axes(rest);
  const Vector residual =
      widths.cwiseInverse().cwiseProduct(axes.vectors.transpose() * group.gradient);
  return factor *
         (left.vectors * left.values.cwiseMax(carried).cwiseSqrt().cwiseInverse().cwiseProduct(
                             left.vectors.transpose() * residual));
}

/// What errors that are common to each frame, or to each link, do to the solution.
Matrix scatter(const Equations& equations, const Matrix& inverse, bool by_frame) {
  Matrix unseen = Matrix::Zero(inverse.rows(), inverse.cols());
  for (const Part& group : sums_of(equations, by_frame)) {
    const Vector gradient = unleveraged(group, inverse);
    unseen += gradient * gradient.transpose() + group.steps * group.steps.transpose();
  }
  return dense::sandwich(inverse, unseen);
}

std::vector<double> medians_by_link(const Residuals& residuals, std::size_t links) {
  std::vector<std::vector<double>> values(links);
  for (const Residual& residual : residuals.list)
    if (residual.kind == Kind::surface) values[residual.link].push_back(residual.value);
  std::vector<double> medians(links, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t link = 0; link < links; ++link)
    if (!values[link].empty()) medians[link] = detail::median(values[link]);
  return medians;
}

Residuals residuals_at(Observer& observer, std::span<const KeptFrame* const> frames,
                       const State& state, const Reach& reach) {
  Residuals residuals;
  for (std::size_t k = 0; k < frames.size(); ++k)
    observer.observe(*frames[k], k, state, reach, residuals);
  return residuals;
}

}  // namespace

Part& Part::operator+=(const Part& other) {
  information += other.information;
  gradient += other.gradient;
  steps += other.steps;
  return *this;
}

Equations Equations::of(const std::vector<int>& chosen) const {
  Equations some = *this;
  some.information = information(chosen, chosen);
  some.gradient = gradient(chosen);
  some.prior = prior(chosen);
  for (Part& part : some.parts)
    if (part.information.size() > 0)
      part = {part.information(chosen, chosen), part.gradient(chosen),
              part.steps(chosen, Eigen::all)};
  return some;
}

Equations Equations::after(const Vector& step) const {
  Equations there = *this;
  there.gradient += information * step;
  for (Part& part : there.parts)
    if (part.information.size() > 0) part.gradient += part.information * step;
  return there;
}

/// The residuals' own and what is expected of the unknowns, which no residual scales, and what
/// frames or links scatter, whichever is larger in each unknown.
Matrix Equations::covariance() const {
  const Matrix inverse = dense::inverse(information);
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].information.size() > 0) seen.insert(views[i]);
  if (seen.size() < 2)
    return Matrix::Constant(inverse.rows(), inverse.cols(),
                            std::numeric_limits<double>::quiet_NaN());
  constexpr double least = std::numeric_limits<double>::min();
  const Matrix by_frame = scatter(*this, inverse, true);
  const Vector scale = scatter(*this, inverse, false)
                           .diagonal()
                           .cwiseQuotient(by_frame.diagonal().cwiseMax(least))  // 0: held
                           .cwiseMax(1.0)
                           .cwiseSqrt();
  return inverse + scale.asDiagonal() * by_frame * scale.asDiagonal();
}

std::vector<double> Equations::wider_without() const {
  const auto position = [](const Matrix& of) {
    return longest_axis(dense::inverse(of).block<3, 3>(3, 3));
  };
  std::vector<double> wider;
  for (const Part& frame : sums_of(*this, true))
    wider.push_back(position(information - frame.information) / position(information));
  return wider;
}

Equations equations_at(Observer& observer, const Unknowns& unknowns,
                       std::span<const KeptFrame* const> frames, const State& state) {
  observer.set_unknowns(unknowns);
  return equations_of(residuals_at(observer, frames, state, last_reach), unknowns, state,
                      views_of(observer.model(), frames), observer.model().robot().links().size());
}

Refined refine(Observer& observer, const Unknowns& unknowns,
               std::span<const KeptFrame* const> frames, State start) {
  const std::size_t links = observer.model().robot().links().size();
  const std::vector<std::size_t> views = views_of(observer.model(), frames);
  observer.set_unknowns(unknowns);
  Refined result{.state = std::move(start), .covariance = {}, .link_residuals = {}};
  Reach reach = first_reach;
  Residuals residuals;
  Equations equations;
  for (int round = 0; round < most_rounds; ++round) {
    residuals = residuals_at(observer, frames, result.state, reach);
    equations = equations_of(residuals, unknowns, result.state, views, links);
    const Vector step = equations.step();
    if (!step.allFinite()) break;
    const bool is_last = reach.depth <= last_reach.depth && reach.pixels <= last_reach.pixels;
    if (is_last && step.head<3>().norm() < small_turn && step.segment<3>(3).norm() < small_shift)
      break;
    unknowns.step(result.state, step);
    reach.depth = std::max(last_reach.depth, narrowing * reach.depth);
    reach.pixels = std::max(last_reach.pixels, narrowing * reach.pixels);
  }
  result.covariance = equations.covariance();
  result.link_residuals = medians_by_link(residuals, links);
  return result;
}

}  // namespace penumbra::calibration
