// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <jerror.h>
#include <jpeglib.h>

#include <io/files/image_size.hpp>
#include <io/files/jpeg.hpp>

namespace penumbra::io {
namespace {

// A block of 64 pixels takes a bit or more of each scan, and has three bytes for each pixel.
constexpr std::uint64_t max_jpeg_expansion = 64 * 3 * 8;

// Each scan of a progressive file goes over all the image; files have about ten.
constexpr int most_scans = 100;

struct JpegFault {
  jpeg_error_mgr manager{};  // first: libjpeg's errors lead back here
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> text{};
};

[[noreturn]] void on_jpeg_error(j_common_ptr codec) {
  auto* fault = reinterpret_cast<JpegFault*>(codec->err);
  codec->err->format_message(codec, fault->text.data());
  std::longjmp(fault->jump, 1);
}

// Warnings are of damaged pixels, but for some that cameras give reason for.
void on_jpeg_message(j_common_ptr codec, int level) {
  const int code = codec->err->msg_code;
  const bool harmless =
      code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR;
  if (level < 0 && !harmless) on_jpeg_error(codec);
}

void on_jpeg_progress(j_common_ptr codec) {
  if (reinterpret_cast<j_decompress_ptr>(codec)->input_scan_number <= most_scans) return;
  codec->err->msg_code = JERR_BAD_PROGRESSION;
  on_jpeg_error(codec);
}

class JpegDecoder {
 public:
  JpegDecoder() {
    codec_.err = jpeg_std_error(&fault_.manager);
    fault_.manager.error_exit = on_jpeg_error;
    fault_.manager.emit_message = on_jpeg_message;
    progress_.progress_monitor = on_jpeg_progress;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&codec_); }

  // Each answers whether it came to its end.
  bool read_header(std::span<const std::byte> bytes) {
    return guarded_jpeg([&] {
      jpeg_create_decompress(&codec_);
      codec_.progress = &progress_;
      jpeg_mem_src(&codec_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
      jpeg_read_header(&codec_, TRUE);
    });
  }

  bool read_rows(ImageView<Rgb8> image) {
    return guarded_jpeg([&] {
      codec_.out_color_space = JCS_RGB;
      jpeg_start_decompress(&codec_);
      while (codec_.output_scanline < codec_.output_height) {
        auto* row = reinterpret_cast<JSAMPROW>(image.row(static_cast<int>(codec_.output_scanline)));
        jpeg_read_scanlines(&codec_, &row, 1);
      }
      jpeg_finish_decompress(&codec_);
    });
  }

  [[nodiscard]] const jpeg_decompress_struct& codec() const { return codec_; }
  [[nodiscard]] std::string damaged() const {
    return std::string("is a damaged JPEG: ") + fault_.text.data();
  }

 private:
  // libjpeg reports a fault by a jump to here: `call` must not hold anything that needs a
  // destructor.
  template <typename F>
  bool guarded_jpeg(const F& call) {
    if (setjmp(fault_.jump) != 0) return false;  // NOLINT: libjpeg's only way
    call();
    return true;
  }

  jpeg_decompress_struct codec_{};
  jpeg_progress_mgr progress_{};
  JpegFault fault_;
};

class JpegEncoder {
 public:
  JpegEncoder() {
    codec_.err = jpeg_std_error(&fault_.manager);
    fault_.manager.error_exit = on_jpeg_error;
  }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    jpeg_destroy_compress(&codec_);
    std::free(file_);  // NOLINT: libjpeg's malloc
  }

  // Answers whether it came to its end.
  bool write(ImageView<const Rgb8> image, int quality) {
    if (setjmp(fault_.jump) != 0) return false;  // NOLINT: libjpeg's only way
    jpeg_create_compress(&codec_);
    jpeg_mem_dest(&codec_, &file_, &size_);
    codec_.image_width = static_cast<JDIMENSION>(image.width);
    codec_.image_height = static_cast<JDIMENSION>(image.height);
    codec_.input_components = 3;
    codec_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&codec_);
    jpeg_set_quality(&codec_, quality, TRUE);
    jpeg_start_compress(&codec_, TRUE);
    while (codec_.next_scanline < codec_.image_height) {
      // libjpeg's rows are not const, but only read.
      auto* row = reinterpret_cast<JSAMPROW>(
          const_cast<Rgb8*>(image.row(static_cast<int>(codec_.next_scanline))));
      jpeg_write_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_compress(&codec_);
    return true;
  }

  [[nodiscard]] std::span<const std::byte> file() const {
    return std::as_bytes(std::span(file_, size_));
  }
  [[nodiscard]] std::string failed() const {
    return std::string("a JPEG cannot be made: ") + fault_.text.data();
  }

 private:
  jpeg_compress_struct codec_{};
  JpegFault fault_;
  unsigned char* file_ = nullptr;
  unsigned long size_ = 0;
};

}  // namespace

std::optional<std::string> decode_jpeg(std::span<const std::byte> bytes, Image<Rgb8>& image) {
  JpegDecoder decoder;
  if (!decoder.read_header(bytes)) return decoder.damaged();
  const jpeg_decompress_struct& codec = decoder.codec();
  if (codec.num_components != 1 && codec.num_components != 3)
    return "is a JPEG of " + std::to_string(codec.num_components) + " colours; expected 1 or 3";
  if (codec.arith_code != FALSE) return "is a JPEG in arithmetic coding, which is not read";
  if (auto fault = check_image_size(codec.image_width, codec.image_height)) return fault;
  const std::uint64_t pixels = std::uint64_t{codec.image_width} * codec.image_height;
  if (3 * pixels > max_jpeg_expansion * bytes.size())
    return "is a JPEG of more pixels than " + std::to_string(bytes.size()) + " bytes can hold";
  image.fit(static_cast<int>(codec.image_width), static_cast<int>(codec.image_height));
  if (!decoder.read_rows(image.view())) return decoder.damaged();
  return std::nullopt;
}

void encode_jpeg(ImageView<const Rgb8> image, int quality, std::vector<std::byte>& bytes) {
  JpegEncoder encoder;
  if (!encoder.write(image, quality)) throw std::runtime_error(encoder.failed());
  const auto file = encoder.file();
  bytes.assign(file.begin(), file.end());
}

}  // namespace penumbra::io
