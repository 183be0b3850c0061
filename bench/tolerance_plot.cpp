// SPDX-License-Identifier: Apache-2.0
#include "tolerance_study.hpp"

#include <array>
#include <cstddef>
#include <iomanip>
#include <sstream>

namespace penumbra::study {
namespace {

constexpr double left = 60, top = 40, across = 560, down = 300;  // the plot's area, pixels
constexpr double largest_x = 10, largest_y = 100;                // cm, percent
constexpr std::array<const char*, 6> colours = {"#1b6ca8", "#c0392b", "#2e8b57",
                                                "#8e44ad", "#b9770e", "#34495e"};

double x_of(double centimetres) { return left + across * centimetres / largest_x; }
double y_of(double percent) { return top + down * (1.0 - percent / largest_y); }

void text(std::ostream& out, double x, double y, const char* anchor, const std::string& words) {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << words
      << "</text>\n";
}

void axes(std::ostream& out) {
  for (int percent = 0; percent <= 100; percent += 20) {
    out << "<path d=\"M" << left << ' ' << y_of(percent) << "h" << across
        << "\" stroke=\"#ddd\"/>\n";
    text(out, left - 8, y_of(percent) + 4, "end", std::to_string(percent));
  }
  for (int centimetres = 0; centimetres <= 10; ++centimetres)
    text(out, x_of(centimetres), top + down + 18, "middle", std::to_string(centimetres));
  text(out, left + across / 2, top + down + 38, "middle", "object before the robot, cm");
  text(out, left, top - 8, "start", "labelled front, % of the object's measured pixels");
}

void curve(std::ostream& out, const Curve& curve, std::size_t index) {
  const char* const colour = colours.at(index % colours.size());
  out << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << colour << "\" points=\"";
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    out << x_of(curve.x[i]) << ',' << y_of(curve.y[i]) << ' ';
  const double y = top + down - 18.0 * static_cast<double>(index) - 16;
  out << "\"/>\n<path d=\"M" << left + across - 270 << ' ' << y
      << "h24\" stroke-width=\"2\" stroke=\"" << colour << "\"/>\n";
  text(out, left + across - 240, y + 4, "start", curve.name);
}

}  // namespace

std::string svg_plot(const std::string& title, const std::vector<Curve>& curves) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 390\" "
         "font-family=\"sans-serif\""
         " font-size=\"12\">\n<title>"
      << title << "</title>\n<rect width=\"640\" height=\"390\" fill=\"#fff\"/>\n";
  axes(out);
  for (std::size_t i = 0; i < curves.size(); ++i) curve(out, curves[i], i);
  out << "</svg>\n";
  return out.str();
}

}  // namespace penumbra::study
