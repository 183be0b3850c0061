// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <io/web/page_files.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::io {
namespace {

/// Puts JSON between the tags of the script with this id.
void fill_in(std::string& page, std::string_view id, std::string_view json) {
  const std::string tag = "<script type=\"application/json\" id=\"" + std::string(id) + "\">";
  const auto start = page.find(tag);
  const auto end = start == std::string::npos ? start : page.find("</script>", start);
  if (end == std::string::npos)
    throw std::logic_error("the report's page has no place for " + std::string(id));
  page.replace(start + tag.size(), end - start - tag.size(), script_json(json));
}

/// The built-in template, with another start.
std::string page_that_begins(std::string_view start) {
  const PageFile* const made = find_page_file("/report.html");
  if (made == nullptr) throw std::logic_error("the report's page is not built in");
  std::string page(made->bytes);
  constexpr std::string_view doctype = "<!doctype html>";
  std::size_t head = 0;
  for (std::size_t i = 0; i < doctype.size() && i < page.size(); ++i)
    if ((page[i] | 0x20) == (doctype[i] | 0x20)) ++head;
  page.replace(0, head == doctype.size() ? head : 0, start);
  return page;
}

}  // namespace

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

std::string report_page(std::string_view report, std::string_view key_frames) {
  std::string page = page_that_begins(report_page_start);
  fill_in(page, "penumbra-report", report);
  fill_in(page, "penumbra-frames", key_frames);
  return page;
}

std::string experiment_page(std::string_view metrics, std::string_view experiment,
                            std::string_view key_frames) {
  std::string page = page_that_begins(experiment_page_start);
  fill_in(page, "penumbra-report", metrics);
  fill_in(page, "penumbra-experiment", experiment);
  fill_in(page, "penumbra-frames", key_frames);
  return page;
}

}  // namespace penumbra::io
