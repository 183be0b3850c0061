// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <python/arrays.hpp>
#include <python/bindings.hpp>

namespace penumbra::python {
namespace {

std::string joined(std::span<const PixelType> types) {
  std::string text;
  for (std::size_t i = 0; i < types.size(); ++i)
    text += (i == 0 ? "" : i + 1 == types.size() ? " or " : ", ") + std::string(types[i].name);
  return text;
}

/// What keeps a row's pixels from lying side by side in whole steps, or nothing.
std::string layout_fault(const py::array& array) {
  const py::ssize_t size = array.itemsize();
  if (array.shape(1) > 1 && array.strides(1) != size)
    return "the pixels of a row do not lie side by side: take numpy.ascontiguousarray";
  if (array.strides(0) % size != 0 ||
      reinterpret_cast<std::uintptr_t>(array.data()) % static_cast<std::uintptr_t>(size) != 0)
    return "its pixels are not aligned: take a copy";
  return {};
}

}  // namespace

std::string description_of(py::handle object) {
  if (object.is_none()) return "None";
  if (!py::isinstance<py::array>(object))
    return py::cast<std::string>(py::type::of(object).attr("__qualname__"));
  return "numpy.ndarray of " + py::cast<std::string>(py::str(object.attr("dtype"))) +
         " with shape " + py::cast<std::string>(py::str(object.attr("shape")));
}

bool is_native(const py::dtype& dtype, int number) {
  return dtype.num() == number && (dtype.byteorder() == '=' || dtype.byteorder() == '|');
}

bool is_bool(py::handle object) {
  return py::isinstance<py::array>(object) &&
         py::reinterpret_borrow<py::array>(object).dtype().num() == py::detail::npy_api::NPY_BOOL_;
}

py::array read_only(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::object keeper_of(std::shared_ptr<const void> owner) {
  if (!owner) return {};
  auto* const kept = new std::shared_ptr<const void>(std::move(owner));
  return py::capsule(kept, [](void* of) { delete static_cast<std::shared_ptr<const void>*>(of); });
}

std::shared_ptr<const void> owner_of(py::object object) {
  return std::shared_ptr<const py::object>(new py::object(std::move(object)),
                                           [](const py::object* of) {
                                             const py::gil_scoped_acquire gil;
                                             delete of;
                                           });
}

std::size_t check_image(py::handle source, const char* argument, std::span<const PixelType> types) {
  const auto complain = [&](const std::string& fault) {
    return std::string(argument) + ": expected numpy.ndarray of " + joined(types) +
           " with shape (H, W); got " + description_of(source) + fault;
  };
  if (!py::isinstance<py::array>(source)) throw py::type_error(complain(""));
  const auto array = py::reinterpret_borrow<py::array>(source);
  if (is_masked(source)) throw py::type_error(complain(mask_fault));
  const py::dtype dtype = array.dtype();
  std::size_t type = 0;
  while (type < types.size() && !is_native(dtype, types[type].number)) ++type;
  const bool takes_float = std::any_of(types.begin(), types.end(), [](const PixelType& of) {
    return of.number == pixel_type<float>.number;
  });
  const bool is_double = is_native(dtype, py::detail::npy_api::NPY_DOUBLE_);
  if (type == types.size())
    throw py::type_error(complain(takes_float && is_double ? ": take .astype(np.float32)" : ""));
  if (array.ndim() != 2 || array.shape(0) < 1 || array.shape(1) < 1 ||
      std::max(array.shape(0), array.shape(1)) > std::numeric_limits<int>::max())
    throw py::value_error(complain(""));
  if (const std::string fault = layout_fault(array); !fault.empty())
    throw py::value_error(complain(": " + fault));
  return type;
}

void check_size(const char* argument, py::ssize_t width, py::ssize_t height, int expected_width,
                int expected_height) {
  if (width == expected_width && height == expected_height) return;
  const auto shape = [](auto rows, auto columns) {
    return "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
  };
  throw py::value_error(std::string(argument) + ": expected shape " +
                        shape(expected_height, expected_width) + "; got " + shape(height, width) +
                        (width == expected_height && height == expected_width
                             ? ": it is transposed; rows come first"
                             : ""));
}

ColorResult array_of(ImageView<const Rgb8> view, std::shared_ptr<const void> owner) {
  static_assert(sizeof(Rgb8) == 3);
  return {read_only(py::array(
      py::dtype::of<std::uint8_t>(),
      {static_cast<py::ssize_t>(view.height), static_cast<py::ssize_t>(view.width), py::ssize_t{3}},
      {3 * view.stride, py::ssize_t{3}, py::ssize_t{1}}, &view.data->r,
      keeper_of(std::move(owner))))};
}

SharedColor color_of(py::handle object, const char* argument) {
  const py::object source = as_array(object);
  const bool is_array = py::isinstance<py::array>(source) && !is_masked(source);
  const auto given = is_array ? py::reinterpret_borrow<py::array>(source) : py::array();
  if (given.ndim() != 3 || given.shape(2) != 3 || given.size() == 0 ||
      !is_native(given.dtype(), pixel_type<std::uint8_t>.number))
    throw py::type_error(std::string(argument) +
                         ": expected numpy.ndarray of uint8 with shape (H, W, 3); got " +
                         description_of(source));
  const auto array = py::array::ensure(given, py::array::c_style);
  const int width = static_cast<int>(array.shape(1)), height = static_cast<int>(array.shape(0));
  const ImageView<const Rgb8> view{static_cast<const Rgb8*>(array.data()), width, height, width};
  return {view, owner_of(array)};
}

OneThread::Use::Use(OneThread& object, const char* what) : lock_(object.mutex_, std::try_to_lock) {
  if (!lock_)
    throw py::value_error(std::string(what) +
                          ": another thread is using it; it serves one thread at a time: make one "
                          "for each thread");
}

}  // namespace penumbra::python
