# SPDX-License-Identifier: Apache-2.0
# Makes a source file that holds the files of a folder: cmake -DFOLDER=... -DOUTPUT=... -P this.
set(type_html "text/html; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_json "application/json")
set(type_webmanifest "application/manifest+json")
set(type_svg "image/svg+xml")
set(type_png "image/png")
set(type_ico "image/x-icon")
set(type_woff2 "font/woff2")
set(type_wasm "application/wasm")
set(type_txt "text/plain; charset=utf-8")

file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT files)
set(arrays "")
set(entries "")
set(number 0)
foreach(file IN LISTS files)
  string(REGEX REPLACE "^.*\\." "" ending ${file})
  if(NOT DEFINED type_${ending})
    message(FATAL_ERROR "${FOLDER}/${file}: of which type is '.${ending}'? Add it to embed_files.cmake")
  endif()
  file(READ ${FOLDER}/${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char file_${number}[] = {${bytes}0x00};\n")
  string(APPEND entries
         "    {\"/${file}\", \"${type_${ending}}\", bytes_of(file_${number}, sizeof file_${number})},\n")
  math(EXPR number "${number} + 1")
endforeach()
if(number EQUAL 0)
  message(FATAL_ERROR "${FOLDER}: has no files; the page is built by npm run build in web/")
endif()

file(WRITE ${OUTPUT} "// Made by embed_files.cmake.
#include <cstddef>

#include <io/web/page_files.hpp>

namespace penumbra::io {
namespace {

${arrays}
/// Without the 0 at the end, which makes no array empty.
std::string_view bytes_of(const unsigned char* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size - 1};
}

}  // namespace

std::span<const PageFile> page_files() {
  static const PageFile files[] = {
${entries}  };
  return files;
}

}  // namespace penumbra::io
")
