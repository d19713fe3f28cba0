#include "tests/artifacts/artifact_values.h"

#include <unistd.h>

#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "common/geometry/samples/samples.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/mesh_support.h"

namespace strake::artifact_test {
namespace {

namespace fs = std::filesystem;

/// Numbers of all sizes with full mantissas, the smallest and negative zero among them.
class Numbers {
 public:
  double operator()() {
    ++calls_;
    if (calls_ % 101 == 0) return -0.0;
    if (calls_ % 103 == 0) return 5e-324;
    return std::ldexp(mantissa_(random_), exponent_(random_));
  }
  Vec3 vector() {
    const double x = (*this)();
    const double y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  std::mt19937_64 random_{3};
  std::uniform_real_distribution<double> mantissa_{-1, 1};
  std::uniform_int_distribution<int> exponent_{-40, 40};
  int calls_ = 0;
};

TriMesh make_mesh() {
  SampleOptions options;
  options.faces = 600;
  TriMesh mesh = support::plain_tri_mesh(make_sample(SampleKind::open_cylinder, options));
  // A feature line along some edges around one vertex, so that wedges differ from vertices.
  for (Index h = 0; h < mesh.halfedge_count(); h += 37) {
    if (mesh.twin[h] == kNone) continue;
    mesh.is_feature[h] = mesh.is_feature[mesh.twin[h]] = 1;
    mesh.is_corner[mesh.from(h)] = 1;
  }
  mesh.origin = {1e6 / 3, -2e6 / 7, 0.1};
  build_wedges(mesh);
  mesh.id = content_id(mesh);
  return mesh;
}

LineSet make_lines(const TriMesh& mesh, Numbers& numbers) {
  LineSet lines;
  lines.mesh_id = mesh.id;
  for (const Index count : {1, 2, 17, 60}) {
    for (Index i = 0; i < count; ++i) {
      const Index halfedge = (7 * i + count) % mesh.halfedge_count();
      lines.points.push_back({halfedge, i % 5 == 0 ? 0 : i / 61.0});
      lines.chord_face.push_back(i + 1 == count ? kNone : halfedge / 3);
      lines.chord_family.push_back(static_cast<LineFamily>(i % 4));
    }
    lines.seed_point.push_back(lines.offsets.back() + count / 2);
    lines.offsets.push_back(static_cast<Index>(lines.points.size()));
    lines.family.push_back(static_cast<LineFamily>(count % 4));
    lines.start_reason.push_back(static_cast<LineEnd>(count % 7));
    lines.end_reason.push_back(count == 60 ? LineEnd::closed : LineEnd::proximity);
  }
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    lines.spacing_along_min.push_back(std::abs(numbers()));
    lines.spacing_along_max.push_back(std::abs(numbers()));
  }
  return lines;
}

QuadMesh make_quads(const TriMesh& mesh, Numbers& numbers) {
  QuadMesh quads;
  quads.mesh_id = mesh.id;
  for (Index v = 0; v < 40; ++v) {
    quads.mesh.positions.push_back(numbers.vector());
    quads.provenance.face.push_back(v % mesh.face_count());
    quads.provenance.barycentric.push_back({numbers(), numbers(), numbers()});
    quads.provenance.lines.push_back({v % 4, v % 3 == 0 ? kNone : v % 2});
  }
  for (Index v = 0; v + 6 < 40; ++v) {
    const std::vector<Index> corners = {v, v + 1, v + 2, v + 3, v + 4, v + 5};
    quads.mesh.add_face({corners.data(), static_cast<std::size_t>(3 + v % 4)});
  }
  return quads;
}

LaidGuides make_guides(const TriMesh& mesh, Numbers& numbers) {
  LaidGuides guides;
  for (const Index count : {1, 5, 30}) {
    for (Index i = 0; i < count; ++i) {
      guides.face.push_back((11 * i + count) % mesh.face_count());
      guides.barycentric.push_back(numbers.vector());
      guides.step.push_back(numbers.vector());
    }
    guides.offsets.push_back(static_cast<Index>(guides.face.size()));
  }
  return guides;
}

TensorPart make_part(const TriMesh& mesh, Numbers& numbers) {
  TensorPart part;
  part.mesh_id = mesh.id;
  part.part = 2;
  part.parts = 3;
  for (Index w = 1; w < mesh.wedge_count(); w += 1 + w % 3) {
    part.wedge.push_back(w);
    part.position.push_back(numbers.vector());
    part.tensor.push_back({numbers(), numbers(), numbers(), numbers(), numbers(), numbers()});
    part.normal.push_back(numbers.vector());
  }
  return part;
}

bool same(const std::vector<LinePoint>& a, const std::vector<LinePoint>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const LinePoint& p, const LinePoint& q) {
           return p.halfedge == q.halfedge && p.lambda == q.lambda;
         });
}

/// Bit by bit, so that -0.0 and 0.0 differ.
template <class Row>
bool same(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Row)) == 0);
}

bool same(const TriMesh& a, const TriMesh& b) {
  return a.id == b.id && same(a.positions, b.positions) && same(a.faces, b.faces) &&
         same(a.twin, b.twin) && same(a.vertex_out, b.vertex_out) &&
         same(a.is_feature, b.is_feature) && same(a.is_corner, b.is_corner) &&
         same(a.face_wedges, b.face_wedges) && same(a.wedge_vertex, b.wedge_vertex) &&
         same(a.source_vertex, b.source_vertex) && same(a.source_face, b.source_face) &&
         a.origin == b.origin && a.diagonal == b.diagonal;
}

bool same(const TensorField& a, const TensorField& b) {
  return a.mesh_id == b.mesh_id && same(a.tensor, b.tensor) && same(a.normal, b.normal);
}

bool same(const TensorPart& a, const TensorPart& b) {
  return a.mesh_id == b.mesh_id && a.part == b.part && a.parts == b.parts &&
         same(a.wedge, b.wedge) && same(a.position, b.position) && same(a.tensor, b.tensor) &&
         same(a.normal, b.normal);
}

bool same(const SizeField& a, const SizeField& b) {
  return a.mesh_id == b.mesh_id && same(a.along, b.along) && same(a.across, b.across);
}

bool same(const PrincipalField& a, const PrincipalField& b) {
  return a.mesh_id == b.mesh_id && same(a.normal, b.normal) && same(a.t_min, b.t_min) &&
         same(a.k_min, b.k_min) && same(a.k_max, b.k_max) && same(a.cross, b.cross) &&
         same(a.wedge_confidence, b.wedge_confidence) &&
         same(a.face_confidence, b.face_confidence) && a.cross_extended == b.cross_extended &&
         same(a.guides.offsets, b.guides.offsets) && same(a.guides.face, b.guides.face) &&
         same(a.guides.barycentric, b.guides.barycentric) && same(a.guides.step, b.guides.step);
}

bool same(const LineSet& a, const LineSet& b) {
  return a.mesh_id == b.mesh_id && same(a.offsets, b.offsets) && same(a.points, b.points) &&
         same(a.chord_face, b.chord_face) && same(a.chord_family, b.chord_family) &&
         same(a.family, b.family) && same(a.start_reason, b.start_reason) &&
         same(a.end_reason, b.end_reason) && same(a.seed_point, b.seed_point) &&
         same(a.spacing_along_min, b.spacing_along_min) &&
         same(a.spacing_along_max, b.spacing_along_max);
}

bool same(const QuadMesh& a, const QuadMesh& b) {
  return a.mesh_id == b.mesh_id && same(a.mesh.positions, b.mesh.positions) &&
         same(a.mesh.offsets, b.mesh.offsets) && same(a.mesh.corners, b.mesh.corners) &&
         same(a.provenance.face, b.provenance.face) &&
         same(a.provenance.barycentric, b.provenance.barycentric) &&
         same(a.provenance.lines, b.provenance.lines);
}

}  // namespace

Values make_values() {
  Numbers numbers;
  Values values;
  values.mesh = make_mesh();
  values.tensor.mesh_id = values.field.mesh_id = values.mesh.id;
  for (Index w = 0; w < values.mesh.wedge_count(); ++w) {
    values.tensor.tensor.push_back(
        {numbers(), numbers(), numbers(), numbers(), numbers(), numbers()});
    values.tensor.normal.push_back(numbers.vector());
    values.field.normal.push_back(numbers.vector());
    values.field.t_min.push_back(numbers.vector());
    values.field.cross.push_back(numbers.vector());
    values.field.k_min.push_back(numbers());
    values.field.k_max.push_back(numbers());
    values.field.wedge_confidence.push_back(numbers());
  }
  for (Index f = 0; f < values.mesh.face_count(); ++f) {
    values.field.face_confidence.push_back(numbers());
  }
  values.field.cross_extended = true;
  values.lines = make_lines(values.mesh, numbers);
  values.quads = make_quads(values.mesh, numbers);
  values.part = make_part(values.mesh, numbers);
  values.size = {values.mesh.id, values.lines.spacing_along_max, values.lines.spacing_along_min};
  for (double& d : values.size.along) d += 5e-324;  // never zero
  for (double& d : values.size.across) d += 5e-324;
  values.field.guides = make_guides(values.mesh, numbers);
  return values;
}

Provenance make_provenance() {
  return {"trace",
          3,
          {{"radius", "1%", true},
           {"name", "a \"quoted\" \\ text \xc3\xa4", false},
           {"none", "", true}},
          {{"mesh", "00112233445566778899aabbccddeeff"}}};
}

std::string content(ArtifactKind kind, const Values& values) {
  switch (kind) {
    case ArtifactKind::mesh:
      return content_of(values.mesh);
    case ArtifactKind::tensor:
      return content_of(values.tensor, values.mesh);
    case ArtifactKind::field:
      return content_of(values.field, values.mesh);
    case ArtifactKind::lines:
      return content_of(values.lines, values.mesh);
    case ArtifactKind::quads:
      return content_of(values.quads);
    case ArtifactKind::tensor_part:
      return content_of(values.part);
    case ArtifactKind::size:
      return content_of(values.size, values.mesh);
  }
  return "";
}

void write(const fs::path& path, ArtifactKind kind, const Values& values,
           const Provenance& provenance) {
  switch (kind) {
    case ArtifactKind::mesh:
      write_artifact(path, values.mesh, provenance);
      break;
    case ArtifactKind::tensor:
      write_artifact(path, values.tensor, values.mesh, provenance);
      break;
    case ArtifactKind::field:
      write_artifact(path, values.field, values.mesh, provenance);
      break;
    case ArtifactKind::lines:
      write_artifact(path, values.lines, values.mesh, provenance);
      break;
    case ArtifactKind::quads:
      write_artifact(path, values.quads, provenance);
      break;
    case ArtifactKind::tensor_part:
      write_artifact(path, values.part, provenance);
      break;
    case ArtifactKind::size:
      write_artifact(path, values.size, values.mesh, provenance);
      break;
  }
}

bool reads_equal(const fs::path& path, ArtifactKind kind, const Values& values) {
  switch (kind) {
    case ArtifactKind::mesh:
      return same(read_tri_mesh(path), values.mesh);
    case ArtifactKind::tensor:
      return same(read_tensor_field(path), values.tensor);
    case ArtifactKind::field:
      return same(read_principal_field(path), values.field);
    case ArtifactKind::lines:
      return same(read_line_set(path), values.lines);
    case ArtifactKind::quads:
      return same(read_quad_mesh(path), values.quads);
    case ArtifactKind::tensor_part:
      return same(read_tensor_part(path), values.part);
    case ArtifactKind::size:
      return same(read_size_field(path), values.size);
  }
  return false;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

void put_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

FolderTest::FolderTest()
    : folder_(fs::temp_directory_path() / ("strake-artifacts-" + std::to_string(::getpid()))) {
  fs::create_directories(folder_);
}

FolderTest::~FolderTest() { fs::remove_all(folder_); }

}  // namespace strake::artifact_test
