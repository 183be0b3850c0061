// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
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
std::vector<std::size_t> views_of(const Model& model,
                                  std::span<const CalibrationFrame* const> frames) {
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
    part.steps.col(static_cast<Eigen::Index>(k)) += weight * rounded[k] * row;
  }
  for (Part& part : all.parts) {
    if (part.information.size() == 0) continue;
    part.information = part.information.selfadjointView<Eigen::Lower>();
    all.information += part.information;
    all.gradient += part.gradient;
  }
  return all;
}

/// The covariance by the jackknife (Efron 1982): how far the solution moves without each group of
/// parts, in one step from all of them. `groups` names each part's. NaN for fewer than two groups.
Matrix jackknife(const Equations& equations, const std::vector<std::size_t>& groups) {
  const Matrix& information = equations.information;
  std::map<std::size_t, Part> left_out;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Part& part = equations.parts[i];
    if (part.information.size() == 0) continue;
    const auto [at, is_new] = left_out.try_emplace(groups[i], part);
    if (!is_new) at->second += part;
  }
  Matrix unseen = equations.prior.asDiagonal();
  for (const auto& [group, part] : left_out) unseen += part.steps * part.steps.transpose();
  const Matrix inverse = dense::inverse(information);
  Matrix covariance = dense::sandwich(inverse, unseen);
  const auto count = static_cast<double>(left_out.size());
  if (left_out.size() < 2)
    return Matrix::Constant(covariance.rows(), covariance.cols(),
                            std::numeric_limits<double>::quiet_NaN());
  for (const auto& [group, part] : left_out) {
    const Vector moved = dense::solve(information - part.information, part.gradient);
    covariance += (count - 1.0) / count * moved * moved.transpose();
  }
  return covariance;
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

Residuals residuals_at(Observer& observer, std::span<const CalibrationFrame* const> frames,
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

/// The largest, in each unknown, of leaving out views, frames and links. With few frames or links
/// it is wider, as the variance of Student's t is with as many degrees of freedom. NaN if all
/// frames repeat one view.
Matrix Equations::covariance() const {
  std::vector<std::size_t> frame_of, link_of;
  std::set<std::size_t> links_in_view;
  for (std::size_t i = 0; i < views.size(); ++i) {
    frame_of.push_back(i / links);
    link_of.push_back(i % links);
    if (parts[i].information.size() > 0) links_in_view.insert(i % links);
  }
  const Matrix by_view = jackknife(*this, views);
  Vector variances = by_view.diagonal().cwiseMax(jackknife(*this, frame_of).diagonal());
  if (links_in_view.size() > 1)
    variances = variances.cwiseMax(jackknife(*this, link_of).diagonal());
  const Vector scale = variances.cwiseQuotient(by_view.diagonal()).cwiseSqrt();
  const auto freedoms = static_cast<double>(std::clamp<std::size_t>(
      links_in_view.size(), 3, std::max<std::size_t>(3, views.size() / links)));
  return freedoms / (freedoms - 2.0) * scale.asDiagonal() * by_view * scale.asDiagonal();
}

Equations equations_at(Observer& observer, const Unknowns& unknowns,
                       std::span<const CalibrationFrame* const> frames, const State& state) {
  observer.set_unknowns(unknowns);
  return equations_of(residuals_at(observer, frames, state, last_reach), unknowns, state,
                      views_of(observer.model(), frames), observer.model().robot().links().size());
}

Refined refine(Observer& observer, const Unknowns& unknowns,
               std::span<const CalibrationFrame* const> frames, State start) {
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
