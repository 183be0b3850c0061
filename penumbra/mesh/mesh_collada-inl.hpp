// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::mesh_formats::collada {

using detail::XmlElement;

/// Throws FormatError that names line and element; `what` ends with a remedy behind a semicolon.
[[noreturn]] void fail(const XmlElement& element, const std::string& what);

/// The same for what only damage or a faulty exporter explains.
[[noreturn]] void damaged_at(const XmlElement& element, const std::string& what);

/// The only child of a name; an error where there is none, or another.
[[nodiscard]] const XmlElement& only_child(const XmlElement& parent, std::string_view name);

/// An attribute that must be there.
[[nodiscard]] const std::string& required(const XmlElement& element, std::string_view name);

/// The id that an attribute such as url="#id" names; other files are not followed.
[[nodiscard]] std::string reference(const XmlElement& element, std::string_view name);

/// An attribute that is a whole number of 0 or more; `otherwise` where it is missing, and an error
/// where that is nothing too.
[[nodiscard]] std::uint64_t count_of(const XmlElement& element, std::string_view name,
                                     std::optional<std::uint64_t> otherwise = std::nullopt);

/// The numbers of an element's text.
[[nodiscard]] std::vector<double> numbers_of(const XmlElement& element);
[[nodiscard]] std::vector<std::int64_t> integers_of(const XmlElement& element);

/// The triangles of a <geometry>, in its own unit.
[[nodiscard]] TriangleMesh read_geometry(const XmlElement& geometry);

}  // namespace penumbra::mesh_formats::collada
