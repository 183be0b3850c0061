// SPDX-License-Identifier: Apache-2.0
// Images between NumPy and C++: looked at where they lie, never copied.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <pybind11/numpy.h>
#include <python/values.hpp>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::python {

namespace py = pybind11;

/// "numpy.ndarray of float64 with shape (3, 3)", or the name of another type.
[[nodiscard]] std::string description_of(py::handle object);

/// Returns an object as a `T`. Throws TypeError, which begins with what was expected, for others.
template <typename T>
[[nodiscard]] T checked_cast(py::handle object, const std::string& expected) {
  try {
    return object.cast<T>();
  } catch (const py::builtin_exception&) {
    throw py::type_error(expected + "; got " + description_of(object));
  }
}

/// Whether it is an array of bool.
[[nodiscard]] bool is_bool(py::handle object);

/// Whether it is NumPy's type of that number, in this machine's byte order. Types that were pickled
/// are other objects.
[[nodiscard]] bool is_native(const py::dtype& dtype, int number);

[[nodiscard]] py::array read_only(py::array array);

/// Returns a Python object that keeps `owner`: the base of arrays on its memory. Null: an array
/// without base is a copy.
[[nodiscard]] py::object keeper_of(std::shared_ptr<const void> owner);

/// Returns what keeps an object, a py::object; it may be dropped on any thread.
[[nodiscard]] std::shared_ptr<const void> owner_of(py::object object);

/// A pixel's type in NumPy.
struct PixelType {
  const char* name;
  int number;
};
template <typename T>
constexpr PixelType pixel_type{};
template <>
inline constexpr PixelType pixel_type<float>{"float32", py::detail::npy_api::NPY_FLOAT_};
template <>
inline constexpr PixelType pixel_type<std::uint8_t>{"uint8", py::detail::npy_api::NPY_UBYTE_};
template <>
inline constexpr PixelType pixel_type<std::uint16_t>{"uint16", py::detail::npy_api::NPY_USHORT_};

/// Throws TypeError or ValueError unless `source` is an array of one of `types` in native byte
/// order, two-dimensional, not empty, aligned, the pixels of a row side by side. `argument` names
/// it. Answers which of the types.
[[nodiscard]] std::size_t check_image(py::handle source, const char* argument,
                                      std::span<const PixelType> types);

/// Of an array that check_image() passed.
template <typename T>
[[nodiscard]] ImageView<const T> view_of(const py::array& array) {
  return {static_cast<const T*>(array.data()), static_cast<int>(array.shape(1)),
          static_cast<int>(array.shape(0)), array.strides(0) / static_cast<py::ssize_t>(sizeof(T))};
}

/// An array of shape (H, W) that views an image, and the types its pixels may have.
template <typename... T>
struct ImageResult {
  py::object array;
};
using DepthResult = ImageResult<std::uint16_t, float>;
/// The same with shape (H, W, 3), uint8: red, green, blue.
using ColorResult = Shown<"Annotated[NDArray[uint8], '(H, W, 3)']">;

/// Returns an array on an image that `owner` keeps, or a copy if there is no owner. If `T` is
/// const, it cannot be written to.
template <typename T>
[[nodiscard]] ImageResult<std::remove_const_t<T>> array_of(ImageView<T> view,
                                                           std::shared_ptr<const void> owner) {
  using Pixel = std::remove_const_t<T>;
  constexpr auto size = static_cast<py::ssize_t>(sizeof(Pixel));
  py::array array(py::dtype::of<Pixel>(),
                  {static_cast<py::ssize_t>(view.height), static_cast<py::ssize_t>(view.width)},
                  {view.stride * size, size}, view.data, keeper_of(std::move(owner)));
  if constexpr (std::is_const_v<T>) array = read_only(std::move(array));
  return {std::move(array)};
}
[[nodiscard]] ColorResult array_of(ImageView<const Rgb8> view, std::shared_ptr<const void> owner);

/// Returns an image that keeps the array, or a copy if its pixels have gaps. Throws TypeError,
/// which names the argument, for what is no array of uint8 with shape (H, W, 3).
[[nodiscard]] SharedColor color_of(py::handle source, const char* argument);

/// An image that the next call of its maker overwrites: copied when it is first read, then kept.
template <typename T>
class ReadImage {
 public:
  /// `find` returns the image, or throws if it is overwritten.
  template <typename Find>
  [[nodiscard]] ImageResult<T> read(Find find) const {
    if (!array_) {
      py::object copy = array_of(find(), nullptr).array;
      static_cast<void>(find());  // NumPy lets other threads run while it copies
      array_ = std::move(copy);
    }
    return {array_};
  }

 private:
  mutable py::object array_;
};

/// An argument that is an image of one of some pixel types.
template <Name Argument, typename... T>
struct ImageArgument {
  py::array array;  ///< keeps the pixels
  std::variant<ImageView<const T>...> view;
};

/// A depth image as sensors give it.
template <Name Argument>
using DepthArgument = ImageArgument<Argument, std::uint16_t, float>;

/// Throws ValueError, which names the argument, for an image of another size.
void check_size(const char* argument, py::ssize_t width, py::ssize_t height, int expected_width,
                int expected_height);
inline void check_size(const py::array& image, const char* argument, int width, int height) {
  check_size(argument, image.shape(1), image.shape(0), width, height);
}

/// Refuses a second thread in an object that serves one at a time.
class OneThread {
 public:
  class Use {
   public:
    /// Throws ValueError, which names `what`, while another thread uses it.
    Use(OneThread& object, const char* what);

   private:
    std::unique_lock<std::mutex> lock_;
  };

 private:
  std::mutex mutex_;
};

}  // namespace penumbra::python

namespace penumbra::python {

template <typename T>
constexpr auto pixel_text() {
  using py::detail::const_name;
  if constexpr (std::is_same_v<T, float>) {
    return const_name("NDArray[float32]");
  } else if constexpr (std::is_same_v<T, std::uint16_t>) {
    return const_name("NDArray[uint16]");
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return const_name("NDArray[int32]");
  } else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return const_name("NDArray[uint8]");
  }
}

/// As it stands in signatures.
template <typename... T>
constexpr auto image_text() {
  using py::detail::const_name;
  if constexpr (sizeof...(T) == 1) {
    return const_name("Annotated[") + (pixel_text<T>(), ...) + const_name(", '(H, W)']");
  } else {
    return const_name("Annotated[Union[") + py::detail::concat(pixel_text<T>()...) +
           const_name("], '(H, W)']");
  }
}

}  // namespace penumbra::python

namespace pybind11::detail {

template <typename... T>
struct type_caster<penumbra::python::ImageResult<T...>>
    : penumbra::python::ValueCaster<penumbra::python::ImageResult<T...>> {
  static constexpr auto name = penumbra::python::image_text<T...>();
  static handle cast(const penumbra::python::ImageResult<T...>& image,
                     return_value_policy /*policy*/, handle /*parent*/) {
    return image.array.inc_ref();
  }
};
template <penumbra::python::Name Argument, typename... T>
struct type_caster<penumbra::python::ImageArgument<Argument, T...>>
    : penumbra::python::ValueCaster<penumbra::python::ImageArgument<Argument, T...>> {
  static constexpr auto name = penumbra::python::image_text<T...>();

  bool load(handle source, bool /*convert*/) {
    static constexpr penumbra::python::PixelType types[] = {penumbra::python::pixel_type<T>...};
    const object given = penumbra::python::as_array(source);
    const std::size_t type = penumbra::python::check_image(given, Argument.text, types);
    this->value.array = reinterpret_borrow<array>(given);
    std::size_t i = 0;
    ((type == i++ ? void(this->value.view = penumbra::python::view_of<T>(this->value.array))
                  : void()),
     ...);
    return true;
  }
  static handle cast(const penumbra::python::ImageArgument<Argument, T...>& image,
                     return_value_policy /*policy*/, handle /*parent*/) {
    return image.array.inc_ref();
  }
};

// Images of a frame. None: empty. They keep what has their pixels.
template <>
struct type_caster<penumbra::SharedDepth> : penumbra::python::ValueCaster<penumbra::SharedDepth> {
  using Argument = make_caster<penumbra::python::DepthArgument<"depth">>;
  static constexpr auto name = const_name("Optional[") + Argument::name + const_name("]");

  bool load(handle source, bool convert) {
    if (source.is_none()) return true;
    Argument given;
    given.load(source, convert);
    value = {given.value.view, penumbra::python::owner_of(given.value.array)};
    return true;
  }
  static handle cast(const penumbra::SharedDepth& depth, return_value_policy /*policy*/,
                     handle /*parent*/) {
    if (is_empty(depth.view)) return none().release();
    return std::visit(
        [&](const auto& view) {
          return penumbra::python::array_of(view, depth.owner).array.release();
        },
        depth.view);
  }
};
template <>
struct type_caster<penumbra::SharedColor> : penumbra::python::ValueCaster<penumbra::SharedColor> {
  static constexpr auto name =
      const_name("Optional[") + make_caster<penumbra::python::ColorResult>::name + const_name("]");

  bool load(handle source, bool /*convert*/) {
    if (!source.is_none()) value = penumbra::python::color_of(source, "color");
    return true;
  }
  static handle cast(const penumbra::SharedColor& color, return_value_policy /*policy*/,
                     handle /*parent*/) {
    if (color.view.empty()) return none().release();
    return penumbra::python::array_of(color.view, color.owner).release();
  }
};

}  // namespace pybind11::detail
