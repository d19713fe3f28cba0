#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "common/artifact/artifact.h"
#include "common/artifact/digest.h"
#include "common/artifact/hdf5_file.h"
#include "common/core/error.h"
#include "tests/artifacts/artifact_values.h"

namespace strake::artifact_test {
namespace {

namespace fs = std::filesystem;

/// While it lives, writing beyond this many bytes of a file fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::size_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit old_{};
  void (*handler_)(int) = nullptr;
};

class RoundTrip : public FolderTest {};
INSTANTIATE_TEST_SUITE_P(Artifact, RoundTrip, kAllKinds, kKindNames);

TEST_P(RoundTrip, IsExact) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  EXPECT_TRUE(reads_equal(file("a.hdf"), GetParam(), values));
}

TEST_P(RoundTrip, EqualValuesGiveEqualBytes) {
  write(file("a.hdf"), GetParam(), make_values(), make_provenance());
  write(file("b.hdf"), GetParam(), make_values(), make_provenance());
  EXPECT_EQ(bytes_of(file("a.hdf")), bytes_of(file("b.hdf")));
  EXPECT_EQ(digest_file(file("a.hdf")), digest_file(file("b.hdf")));
}

TEST_P(RoundTrip, LeavesAnEqualFileUntouched) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const auto long_ago = fs::last_write_time(file("a.hdf")) - std::chrono::hours(5);
  fs::last_write_time(file("a.hdf"), long_ago);
  write(file("a.hdf"), GetParam(), values, make_provenance());
  EXPECT_EQ(fs::last_write_time(file("a.hdf")), long_ago);
}

TEST_P(RoundTrip, SaysWhatItIsAndHowItWasMade) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const ArtifactInfo info = read_artifact_info(file("a.hdf"));
  EXPECT_EQ(info.kind, GetParam());
  EXPECT_EQ(info.format_version, kFormatVersion);
  EXPECT_EQ(info.mesh_id, values.mesh.id);
  EXPECT_EQ(info.provenance, make_provenance());
  EXPECT_FALSE(info.datasets.empty());
  for (const auto& dataset : info.datasets) EXPECT_GT(dataset.rows, 0) << dataset.name;
}

TEST_P(RoundTrip, ContentIsWhatItSaysHoweverItWasMade) {
  Provenance other = make_provenance();
  other.stage_version += 1;
  Values moved = make_values();
  moved.mesh.positions.front().x() += 1;
  moved.tensor.normal.front().x() += 1;
  moved.field.normal.front().x() += 1;
  moved.lines.spacing_along_min.front() += 1;
  moved.quads.mesh.positions.front().x() += 1;
  moved.part.normal.front().x() += 1;
  write(file("a.hdf"), GetParam(), make_values(), make_provenance());
  write(file("b.hdf"), GetParam(), make_values(), other);
  write(file("c.hdf"), GetParam(), moved, make_provenance());
  EXPECT_NE(digest_file(file("a.hdf")), digest_file(file("b.hdf")));
  EXPECT_EQ(content_digest(file("a.hdf")), content_digest(file("b.hdf")));
  EXPECT_NE(content_digest(file("a.hdf")), content_digest(file("c.hdf")));
}

TEST_P(RoundTrip, ContentIsKnownWithoutAFile) {
  write(file("a.hdf"), GetParam(), make_values(), make_provenance());
  EXPECT_EQ(content(GetParam(), make_values()), content_digest(file("a.hdf")));
}

TEST_P(RoundTrip, LeavesNothingElseBehind) {
  write(file("a.hdf"), GetParam(), make_values(), make_provenance());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_P(RoundTrip, OldFileSurvivesAFailedWrite) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const std::string bytes = bytes_of(file("a.hdf"));
  Provenance other = make_provenance();
  other.stage_version += 1;
  {
    // A file may grow to a quarter of what it needs: as if the disk were full.
    const FileSizeLimit limit(bytes.size() / 4);
    EXPECT_THROW(write(file("a.hdf"), GetParam(), values, other), InputError);
  }
  EXPECT_EQ(bytes_of(file("a.hdf")), bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

using Artifacts = FolderTest;

/// Wherever in the file: HDF5 by itself would crash, at the latest when the program ends.
TEST_F(Artifacts, ADiskThatIsFullIsNoticed) {
  const std::vector<double> rows(3'000'000, 1.0);
  const auto write = [&] {
    hdf5::Writer writer(file("a.hdf"), file("a.hdf"));
    writer.dataset("/rows", rows);
    writer.finish();
  };
  write();
  const auto size = std::filesystem::file_size(file("a.hdf"));
  for (const std::uintmax_t room : {std::uintmax_t{0}, std::uintmax_t{100}, size / 2, size - 1}) {
    SCOPED_TRACE(room);
    const FileSizeLimit limit(room);
    EXPECT_THROW(write(), InputError);
  }
  const FileSizeLimit limit(size);
  EXPECT_NO_THROW(write());
}

TEST_F(Artifacts, EmptyLineSetSurvives) {
  const Values values = make_values();
  LineSet lines;
  lines.mesh_id = values.mesh.id;
  write_artifact(file("a.hdf"), lines, values.mesh, make_provenance());
  const LineSet read = read_line_set(file("a.hdf"));
  EXPECT_EQ(read.line_count(), 0);
  EXPECT_TRUE(read.points.empty());
}

TEST_F(Artifacts, LargerThanOneChunkSurvive) {
  Values values = make_values();
  auto& positions = values.quads.mesh.positions;
  for (int i = 0; i < 100000; ++i) positions.push_back(Vec3::Constant(i / 3.0));
  values.quads.provenance.face.resize(positions.size());
  values.quads.provenance.barycentric.resize(positions.size());
  values.quads.provenance.lines.resize(positions.size());
  write(file("a.hdf"), ArtifactKind::quads, values, make_provenance());
  EXPECT_TRUE(reads_equal(file("a.hdf"), ArtifactKind::quads, values));
}

TEST_F(Artifacts, BlocksOfAMeshAreItsRows) {
  const TriMesh mesh = make_values().mesh;
  write_artifact(file("a.hdf"), mesh, make_provenance());
  const auto blocks = open_tri_mesh(file("a.hdf"));
  EXPECT_EQ(blocks->header().id, mesh.id);
  EXPECT_EQ(blocks->header().diagonal, mesh.diagonal);
  EXPECT_EQ(blocks->header().vertices, mesh.vertex_count());
  EXPECT_EQ(blocks->header().faces, mesh.face_count());
  EXPECT_EQ(blocks->header().wedges, mesh.wedge_count());
  constexpr Index kFirst = 11;
  for (Index i = 0; i < 100; ++i) {
    const Index f = kFirst + i;
    EXPECT_EQ(blocks->positions(kFirst, 100)[i], mesh.positions[f]);
    EXPECT_EQ(blocks->wedge_vertex(kFirst, 100)[i], mesh.wedge_vertex[f]);
    EXPECT_EQ(blocks->faces(kFirst, 100)[i], mesh.faces[f]);
    EXPECT_EQ(blocks->face_wedges(kFirst, 100)[i], mesh.face_wedges[f]);
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(blocks->twin(kFirst, 100)[i][corner], mesh.twin[3 * f + corner]);
      EXPECT_EQ(blocks->is_feature(kFirst, 100)[i][corner], mesh.is_feature[3 * f + corner]);
    }
  }
}

TEST_F(Artifacts, AreRecognisedByContent) {
  write(file("a.obj"), ArtifactKind::mesh, make_values(), make_provenance());
  put_bytes(file("b.hdf"), "v 0 0 0\n");
  EXPECT_TRUE(is_artifact(file("a.obj")));
  EXPECT_FALSE(is_artifact(file("b.hdf")));
  EXPECT_FALSE(is_artifact(file("missing")));
}

TEST_F(Artifacts, DigestIsTheOneOfTheReferenceTool) {
  // `xxh128sum` of these bytes.
  put_bytes(file("empty"), "");
  EXPECT_EQ(digest_file(file("empty")), "99aa06d3014798d86001c324468d497f");
  EXPECT_THROW(digest_file(file("missing")), InputError);
}

TEST_F(Artifacts, ProvenanceTextReadsBack) {
  EXPECT_EQ(Provenance::from_json(make_provenance().to_json()), make_provenance());
  for (const char* text : {"", "{", "[]", "{\"stage\": 3}"}) {
    EXPECT_THROW(Provenance::from_json(text), InputError) << text;
  }
}

}  // namespace
}  // namespace strake::artifact_test
