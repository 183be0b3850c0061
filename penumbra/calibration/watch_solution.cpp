// SPDX-License-Identifier: Apache-2.0
#include <penumbra/calibration/watch_solution-inl.hpp>

namespace penumbra::watching {

constexpr double least_places = 12.0;
/// A place that alone carries a direction scatters nothing there: of what independent residuals
/// would give, so much always counts.
constexpr double least_share = 0.06;

std::optional<Solution> solve(std::vector<const View*> views, const Prior& prior) {
  Matrix information = prior.information;
  Vector gradient = -prior.information * prior.value;
  for (const View* view : views) {
    information += view->weight() * view->information;
    gradient += view->weight() * view->gradient;
  }
  Solution solution{.value = -dense::solve(information, gradient),
                    .covariance = {},
                    .information = information,
                    .gradient = gradient};
  if (!solution.value.allFinite()) return std::nullopt;
  std::ranges::sort(views, {}, &View::place);
  Matrix meat = Matrix::Zero();
  double count = 0.0;
  for (auto view = views.begin(); view != views.end(); ++count) {
    Vector sum = Vector::Zero();
    for (const std::size_t place = (*view)->place; view != views.end() && (*view)->place == place;
         ++view)
      sum += (*view)->weight() * ((*view)->gradient + (*view)->information * solution.value);
    meat += sum * sum.transpose();
  }
  if (count < least_places) return std::nullopt;
  meat = prior.information + count / (count - 7.0) * meat;
  const Matrix inverse = dense::inverse(information);
  solution.covariance = least_share * inverse + dense::sandwich(inverse, meat);
  return solution;
}

}  // namespace penumbra::watching
