// SPDX-License-Identifier: Apache-2.0
// Pages that are one file.
#pragma once

#include <array>
#include <cctype>
#include <cstdio>
#include <string>
#include <vector>

#include <io/files/result_folder.hpp>

namespace penumbra::io {

inline std::string number(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// Returns plain text for HTML and for an attribute in double quotes.
inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

/// Returns a folder's name for the path of a URL.
inline std::string url_of(const std::string& name) {
  std::string url;
  for (const char c : name) {
    std::array<char, 4> code{};
    std::snprintf(code.data(), code.size(), "%%%02X", static_cast<unsigned char>(c));
    url += std::isalnum(static_cast<unsigned char>(c)) != 0 ? std::string(1, c) : code.data();
  }
  return url;
}

/// Returns the start of a page with its style and heading. `title` is plain text.
inline std::string page_start(const std::string& title) {
  constexpr const char* style = R"(<style>
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1280px; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: 1em 0; }
td, th { padding: .2em 1em .2em 0; text-align: left; border-bottom: 1px solid #ccc; }
td { font-variant-numeric: tabular-nums; }
figure { display: grid; grid-template-columns: 1fr 1fr; gap: 6px; margin: 1em 0; }
figcaption { grid-column: 1 / 3; }
img { width: 100%; }
.bad { color: #b00020; }
</style>
)";
  return std::string(page_begin) + " -->\n<html lang=\"en\"><meta charset=\"utf-8\">\n<title>" +
         escaped(title) + "</title>\n" + style + "<h1>" + escaped(title) + "</h1>\n";
}

using Rows = std::vector<std::vector<std::string>>;

/// Returns a table of plain text. The first row is the header.
inline std::string table(const Rows& rows) {
  std::string html = "<table>\n";
  for (const auto& row : rows) {
    const std::string cell = &row == &rows.front() ? "th" : "td";
    html += "<tr>";
    for (const std::string& text : row)
      html.append("<")
          .append(cell)
          .append(">")
          .append(escaped(text))
          .append("</")
          .append(cell)
          .append(">");
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace penumbra::io
