#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "common/artifact/artifact.h"

/// One value of every kind of artifact, of one small mesh with features and a boundary.
namespace strake::artifact_test {

struct Values {
  TriMesh mesh;
  TensorField tensor;
  PrincipalField field;
  LineSet lines;
  QuadMesh quads;
  TensorPart part;
  SizeField size;
};

/// Values with numbers that do not survive a detour over text or single precision.
Values make_values();
Provenance make_provenance();

/// `content_of` the value of that kind.
std::string content(ArtifactKind kind, const Values& values);
void write(const std::filesystem::path& path, ArtifactKind kind, const Values& values,
           const Provenance& provenance);
/// Reads the file back and compares bit by bit with what `write` was given.
/// \throw InputError as the reader does
bool reads_equal(const std::filesystem::path& path, ArtifactKind kind, const Values& values);

std::string bytes_of(const std::filesystem::path& path);
void put_bytes(const std::filesystem::path& path, const std::string& bytes);

/// A test that has a folder of its own, removed afterwards.
class FolderTest : public testing::TestWithParam<ArtifactKind> {
 protected:
  FolderTest();
  ~FolderTest() override;
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  std::filesystem::path folder_;
};

inline const auto kAllKinds = testing::Values(
    ArtifactKind::mesh, ArtifactKind::tensor, ArtifactKind::field, ArtifactKind::lines,
    ArtifactKind::quads, ArtifactKind::tensor_part, ArtifactKind::size);
inline const auto kKindNames = [](const testing::TestParamInfo<ArtifactKind>& info) {
  return kind_name(info.param);
};

}  // namespace strake::artifact_test
