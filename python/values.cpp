#include "python/values.h"

#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/core/error.h"

namespace strake::python {
namespace {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// The numbers an element of a vector consists of.
template <class T>
struct Row {
  using Number = T;
  static constexpr py::ssize_t kWidth = 1;
};
template <>
struct Row<Vec3> {
  using Number = double;
  static constexpr py::ssize_t kWidth = 3;
};
template <class T, std::size_t N>
struct Row<std::array<T, N>> {
  using Number = T;
  static constexpr py::ssize_t kWidth = N;
};
template <>
struct Row<LineFamily> {
  using Number = std::uint8_t;
  static constexpr py::ssize_t kWidth = 1;
};
template <>
struct Row<LineEnd> : Row<LineFamily> {};

/// A vector as an array that shares its memory, cannot be written to and keeps `owner` alive.
template <class T>
py::array view(const std::vector<T>& vector, const py::object& owner, py::ssize_t width = 0) {
  using Number = typename Row<T>::Number;
  static_assert(sizeof(T) == sizeof(Number) * Row<T>::kWidth);
  const py::ssize_t columns = width > 0 ? width : Row<T>::kWidth;
  const auto numbers = static_cast<py::ssize_t>(vector.size()) * Row<T>::kWidth;
  std::vector<py::ssize_t> shape = {numbers / columns};
  if (columns > 1) shape.push_back(columns);
  py::array_t<Number> array(shape, reinterpret_cast<const Number*>(vector.data()), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A class for values of type T, whose properties are arrays.
template <class T>
class ValueClass {
 public:
  ValueClass(py::module_& module, const char* name, const char* doc) : class_(module, name, doc) {}

  /// \param get  gives a vector that is a part of the value
  template <class Get>
  ValueClass& array(const char* name, Get get, const char* doc, py::ssize_t width = 0) {
    class_.def_property_readonly(
        name,
        [get, width](const py::object& self) {
          return view(get(self.cast<const HeldAs<T>&>().get()), self, width);
        },
        doc);
    return *this;
  }
  /// \param get  gives any value
  template <class Get>
  ValueClass& plain(const char* name, Get get, const char* doc) {
    class_.def_property_readonly(
        name, [get](const HeldAs<T>& self) { return get(self.get()); }, doc);
    return *this;
  }

 private:
  py::class_<HeldAs<T>, Held> class_;
};

/// Properties of all values that have attributes. \param attributes  gives the Attributes
template <class T, class Give>
void add_attribute_properties(ValueClass<T>& value_class, Give attributes) {
  value_class
      .array(
          "colours",
          [attributes](const T& value) -> const auto& { return attributes(value).colour; },
          "[V, 4] red, green, blue, opacity in [0, 1]; empty where there are none")
      .array(
          "texture",
          [attributes](const T& value) -> const auto& { return attributes(value).texture; },
          "[corners, 2] texture coordinates of each corner; empty where there are none")
      .plain(
          "labels",
          [attributes](const T& value) {
            py::dict labels;
            for (const FaceLabels& own : attributes(value).labels) {
              labels[py::str(own.name)] = py::array_t<Index>(
                  static_cast<py::ssize_t>(own.of_face.size()), own.of_face.data());
            }
            return labels;
          },
          "dict of [F] arrays: a number for every face, by kind of labels")
      .plain(
          "label_names",
          [attributes](const T& value) {
            std::map<std::string, std::vector<std::string>> names;
            for (const FaceLabels& own : attributes(value).labels) {
              if (!own.names.empty()) names[own.name] = own.names;
            }
            return names;
          },
          "dict of lists: what the numbers of `labels` stand for, for kinds that have names");
}

/// The members of T as functions that give them.
#define STRAKE_MEMBER(member) \
  [](const auto& value) -> const auto& { return value.member; }

void add_mesh(py::module_& module) {
  ValueClass<TriMesh> meshes(
      module, "TriMesh",
      "A sound triangle mesh with its feature graph: V vertices, F faces, W wedges.\n\n"
      "Half-edge 3 f + i runs from corner i of face f to the next. A wedge is a run "
      "of corners around a vertex between two feature or boundary edges; fields "
      "live on wedges.");
  meshes.array("positions", STRAKE_MEMBER(positions), "[V, 3] relative to `origin`")
      .array("faces", STRAKE_MEMBER(faces), "[F, 3] counter-clockwise seen from outside")
      .array("twin", STRAKE_MEMBER(twin), "[F, 3] opposite half-edge, -1 on the boundary", 3)
      .array("is_feature", STRAKE_MEMBER(is_feature), "[F, 3] 1 on feature half-edges", 3)
      .array("is_corner", STRAKE_MEMBER(is_corner), "[V] 1 where feature lines end or meet")
      .array("face_wedges", STRAKE_MEMBER(face_wedges), "[F, 3] wedge of each corner")
      .array("wedge_vertex", STRAKE_MEMBER(wedge_vertex), "[W] vertex of each wedge")
      .array("source_vertex", STRAKE_MEMBER(source_vertex), "[V] vertex of the input")
      .array("source_face", STRAKE_MEMBER(source_face), "[F] face of the input")
      .plain(
          "origin",
          [](const TriMesh& mesh) {
            return std::array{mesh.origin.x(), mesh.origin.y(), mesh.origin.z()};
          },
          "to be added to `positions`")
      .plain("diagonal", STRAKE_MEMBER(diagonal), "of the bounding box")
      .plain("id", STRAKE_MEMBER(id), "content hash");
  add_attribute_properties(meshes, STRAKE_MEMBER(attributes));
}

void add_fields(py::module_& module) {
  ValueClass<TensorField>(module, "TensorField", "Curvature tensors of a mesh, one per wedge.")
      .array("tensor", STRAKE_MEMBER(tensor),
             "[W, 6] xx, xy, xz, yy, yz, zz; 1/length, positive where convex")
      .array("normal", STRAKE_MEMBER(normal), "[W, 3] unit")
      .plain("mesh_id", STRAKE_MEMBER(mesh_id), "of its mesh");
  ValueClass<PrincipalField>(module, "PrincipalField",
                             "Principal directions of a mesh, one frame per wedge.")
      .array("normal", STRAKE_MEMBER(normal), "[W, 3] unit")
      .array("t_min", STRAKE_MEMBER(t_min), "[W, 3] unit, direction of k_min, sign free")
      .array("k_min", STRAKE_MEMBER(k_min), "[W] 1/length, |k_min| <= |k_max|")
      .array("k_max", STRAKE_MEMBER(k_max), "[W] 1/length, along normal x t_min")
      .array("cross", STRAKE_MEMBER(cross), "[W, 3] one arm of the cross that lines follow")
      .array("wedge_confidence", STRAKE_MEMBER(wedge_confidence), "[W] in [0, 1]")
      .array("face_confidence", STRAKE_MEMBER(face_confidence), "[F] in [0, 1]")
      .plain("mesh_id", STRAKE_MEMBER(mesh_id), "of its mesh");
  ValueClass<SizeField>(module, "SizeField", "Wanted distances between lines, one per wedge.")
      .array("along", STRAKE_MEMBER(along), "[W] measured along the field's cross")
      .array("across", STRAKE_MEMBER(across), "[W] measured across it")
      .plain("mesh_id", STRAKE_MEMBER(mesh_id), "of its mesh");
}

std::vector<Vec3> line_points(const TriMesh& mesh, const LineSet& lines) {
  std::vector<Vec3> points;
  points.reserve(lines.points.size());
  for (const LinePoint& point : lines.points) {
    const Vec3& from = mesh.positions[mesh.from(point.halfedge)];
    const Vec3& to = mesh.positions[mesh.to(point.halfedge)];
    points.push_back(mesh.origin + from + point.lambda * (to - from));
  }
  return points;
}

void add_lines(py::module_& module) {
  ValueClass<LineSet>(module, "LineSet",
                      "Lines on a mesh: L lines, P points. Families: 0 minimum, 1 maximum, 2 "
                      "boundary, 3 feature.")
      .array("offsets", STRAKE_MEMBER(offsets), "[L + 1] line l has points offsets[l] and on")
      .array("chord_face", STRAKE_MEMBER(chord_face), "[P] face of the chord to the next point")
      .array("family", STRAKE_MEMBER(family), "[L] at the seed")
      .array("end_reason", STRAKE_MEMBER(end_reason), "[L] 0 where the line is closed")
      .plain("mesh_id", STRAKE_MEMBER(mesh_id), "of its mesh");
  module.def(
      "line_points",
      [](const HeldAs<TriMesh>& mesh, const HeldAs<LineSet>& lines) {
        check_belongs(mesh.get(), "mesh", *lines.value, "lines");
        const std::vector<Vec3> points = line_points(mesh.get(), lines.get());
        py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
        std::copy_n(points.empty() ? nullptr : points.front().data(), 3 * points.size(),
                    array.mutable_data());
        return array;
      },
      py::arg("mesh"), py::arg("lines"), "[P, 3] the points of lines, in coordinates of the input");
}

/// Properties that all values with polygons share. \param mesh  gives the PolyMesh
template <class T, class Mesh>
void add_polygon_properties(ValueClass<T>& value_class, Mesh mesh) {
  value_class
      .array(
          "vertices", [mesh](const T& value) -> const auto& { return mesh(value).positions; },
          "[V, 3]")
      .array(
          "offsets", [mesh](const T& value) -> const auto& { return mesh(value).offsets; },
          "[F + 1] face f has corners offsets[f] and on")
      .array(
          "corners", [mesh](const T& value) -> const auto& { return mesh(value).corners; },
          "vertex of each corner, counter-clockwise");
  add_attribute_properties(
      value_class, [mesh](const T& value) -> const auto& { return mesh(value).attributes; });
}

void add_polygons(py::module_& module) {
  ValueClass<Polygons> polygons(module, "Polygons", "A polygon mesh as it was given.");
  add_polygon_properties(
      polygons, [](const Polygons& value) -> const auto& { return value.mesh; });
  ValueClass<QuadMesh> quads(module, "QuadMesh",
                             "A remeshed surface, and where on its mesh each vertex lies.");
  add_polygon_properties(
      quads, [](const QuadMesh& value) -> const auto& { return value.mesh; });
  quads.array("foot_face", STRAKE_MEMBER(provenance.face), "[V] face of the TriMesh")
      .array("foot_barycentric", STRAKE_MEMBER(provenance.barycentric), "[V, 3] in that face")
      .array("foot_lines", STRAKE_MEMBER(provenance.lines), "[V, 2] lines that cross there, or -1")
      .plain("mesh_id", STRAKE_MEMBER(mesh_id), "of its mesh");
}

#undef STRAKE_MEMBER

/// Rows of an array. \throw InputError where it is not [N, Width]
template <class T, std::size_t Width>
std::vector<std::array<T, Width>> rows(const Array<T>& array, const char* what) {
  if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(Width)) {
    throw InputError(std::string(what) + " are not an array of " + std::to_string(Width) +
                     " columns");
  }
  std::vector<std::array<T, Width>> result(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::copy_n(array.data() + i * Width, Width, result[i].begin());
  }
  return result;
}

template <class T>
std::vector<T> numbers(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}

/// Whether face f has the corners offsets[f] ... offsets[f + 1] - 1, all of them there.
bool are_offsets(const std::vector<Index>& offsets, std::size_t corners) {
  return !offsets.empty() && offsets.front() == 0 &&
         offsets.back() == static_cast<Index>(corners) &&
         std::is_sorted(offsets.begin(), offsets.end());
}

py::object make_polygons(const Array<double>& vertices, const Array<Index>& offsets,
                         const Array<Index>& corners, const std::optional<Array<double>>& colours,
                         const std::optional<Array<double>>& texture,
                         const std::map<std::string, Array<Index>>& labels,
                         const std::map<std::string, std::vector<std::string>>& label_names) {
  PolyMesh mesh;
  for (const auto& row : rows<double, 3>(vertices, "vertices")) {
    mesh.positions.push_back({row[0], row[1], row[2]});
  }
  mesh.offsets = numbers(offsets);
  mesh.corners = numbers(corners);
  if (!are_offsets(mesh.offsets, mesh.corners.size())) {
    throw InputError("offsets do not run from 0 to the number of corners without falling");
  }
  if (colours) mesh.attributes.colour = rows<double, 4>(*colours, "colours");
  if (colours && mesh.attributes.colour.size() != mesh.positions.size()) {
    throw InputError("there is not one colour for every vertex");
  }
  if (texture) mesh.attributes.texture = rows<double, 2>(*texture, "texture coordinates");
  if (texture && mesh.attributes.texture.size() != mesh.corners.size()) {
    throw InputError("there are not texture coordinates for every corner");
  }
  for (const auto& [name, array] : labels) {
    const auto names = label_names.find(name);
    mesh.attributes.labels.push_back(
        {name, numbers(array),
         names == label_names.end() ? std::vector<std::string>{} : names->second});
    if (array.size() != mesh.face_count()) {
      throw InputError("labels '" + name + "': there is not one for every face");
    }
  }
  return hold(Polygons{std::move(mesh), "", {}});
}

}  // namespace

py::object held(std::shared_ptr<Value> value) {
  return std::visit(
      [&]<class T>(const T&) -> py::object {
        if constexpr (std::is_same_v<T, OpenedMesh> || std::is_same_v<T, TensorPart>) {
          throw Error(ExitCode::internal, "this value stays inside");
        } else {
          HeldAs<T> object;
          object.value = value;
          return py::cast(std::move(object));
        }
      },
      *value);
}

py::dict report_dict(const Report& report) {
  py::dict dict;
  for (const auto& [key, value] : report.entries()) {
    std::visit([&, name = py::str(key)](const auto& held) { dict[name] = held; }, value);
  }
  return dict;
}

void add_values(py::module_& module) {
  py::class_<Held>(module, "Value", "What goes from stage to stage. It never changes.");
  add_mesh(module);
  add_fields(module);
  add_lines(module);
  add_polygons(module);
  py::class_<HeldAs<EdgeList>, Held>(module, "EdgeList", "Edges of the input to keep.");
  py::class_<HeldAs<GuideLines>, Held>(module, "GuideLines", "Lines for edges to run along.");
  py::class_<HeldAs<DensityField>, Held>(module, "DensityField", "Wanted vertices per area.");
  module.def("polygons", &make_polygons, py::arg("vertices"), py::arg("offsets"),
             py::arg("corners"), py::arg("colours") = py::none(), py::arg("texture") = py::none(),
             py::arg("labels") = py::dict(), py::arg("label_names") = py::dict());
  module.def("polygons_of", [](const HeldAs<QuadMesh>& quads) {
    return hold(Polygons{quads.get().mesh, quads.get().mesh_id, {}});
  });
  module.def("edge_list", [](const Array<Index>& edges) {
    EdgeList list;
    list.name = "feature_edges";
    for (const auto& [from, to] : rows<Index, 2>(edges, "feature_edges")) {
      list.edges.push_back({from, to, static_cast<int>(list.edges.size()) + 1});
    }
    return hold(std::move(list));
  });
  module.def("guides", [](const std::vector<Array<double>>& lines) {
    GuideLines guides;
    guides.name = "guides";
    for (const Array<double>& line : lines) {
      guides.lines.emplace_back();
      for (const auto& row : rows<double, 3>(line, "points of a guide")) {
        guides.lines.back().push_back({row[0], row[1], row[2]});
      }
      if (guides.lines.back().size() < 2) throw InputError("a guide has fewer than two points");
    }
    return hold(std::move(guides));
  });
  module.def("density", [](const Array<double>& values) {
    return hold(DensityField{"", numbers(values)});
  });
}

}  // namespace strake::python
