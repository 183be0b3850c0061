// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <io/web/page_files.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::io {
namespace {

/// Returns JSON that a <script> may hold: '<' is written as \u003c.
std::string script_json(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

/// Inserts JSON into the script element with this id.
void fill_in(std::string& page, std::string_view id, std::string_view json) {
  const std::string tag = "<script type=\"application/json\" id=\"" + std::string(id) + "\">";
  const auto start = page.find(tag);
  const auto end = start == std::string::npos ? start : page.find("</script>", start);
  if (end == std::string::npos)
    throw std::logic_error("the report's page has no place for " + std::string(id));
  page.replace(start + tag.size(), end - start - tag.size(), script_json(json));
}

}  // namespace

std::string report_page(std::string_view report, std::string_view key_frames) {
  constexpr std::string_view doctype = "<!doctype html>\n";
  const PageFile* const made = find_page_file("/report.html");
  if (made == nullptr || !made->bytes.starts_with(doctype))
    throw std::logic_error("the report's page is not built in");
  std::string page(report_page_start);
  page += made->bytes.substr(doctype.size());
  fill_in(page, "penumbra-report", report);
  fill_in(page, "penumbra-frames", key_frames);
  return page;
}

}  // namespace penumbra::io
