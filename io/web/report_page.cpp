// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <io/files/jpeg.hpp>
#include <io/files/json.hpp>
#include <io/files/result_folder.hpp>
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

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0U;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::string picture_uri(ImageView<const Rgb8> image) {
  constexpr int quality = 80;
  std::vector<std::byte> jpeg;
  encode_jpeg(image, quality, jpeg);
  return "data:image/jpeg;base64," + base64(jpeg);
}

std::string report_page(std::string_view json, std::span<const PagePicture> pictures) {
  constexpr std::string_view doctype = "<!doctype html>\n";
  const PageFile* const made = find_page_file("/report.html");
  if (made == nullptr || !made->bytes.starts_with(doctype))
    throw std::logic_error("the report's page is not built in");
  Json all = Json::array();
  for (const PagePicture& picture : pictures)
    all.push_back({{"index", picture.index}, {"image", picture.uri}, {"caption", picture.caption}});
  std::string page = std::string(page_begin) + " -->\n";
  page += made->bytes.substr(doctype.size());
  fill_in(page, "penumbra-report", json);
  fill_in(page, "penumbra-pictures", json_text(all));
  return page;
}

}  // namespace penumbra::io
