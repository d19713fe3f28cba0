#include <gtest/gtest.h>
#include <hdf5.h>
#include <malloc.h>

#include <functional>
#include <random>

#include "common/artifact/artifact.h"
#include "common/core/error.h"
#include "tests/artifacts/artifact_values.h"

namespace strake::artifact_test {
namespace {

namespace fs = std::filesystem;

class Damage : public FolderTest {
 protected:
  /// The message with which reading is refused; fails the test where it is not.
  std::string refusal(ArtifactKind kind, const Values& values) {
    try {
      reads_equal(file("a.hdf"), kind, values);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("a.hdf"), std::string::npos) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "the file was accepted";
    return "";
  }
  /// Changes the file with the HDF5 library, as another program could.
  void edit(const std::function<void(hid_t)>& change) {
    const hid_t opened = H5Fopen(file("a.hdf").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(opened, 0);
    change(opened);
    H5Fclose(opened);
  }
  void set_version(std::int64_t version) {
    edit([&](hid_t opened) {
      const hid_t attribute = H5Aopen(opened, "format_version", H5P_DEFAULT);
      EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &version), 0);
      H5Aclose(attribute);
    });
  }
  /// Overwrites one scalar of a dataset.
  template <class T>
  void set_scalar(const std::string& name, hsize_t at, hid_t type, T value) {
    edit([&](hid_t opened) {
      const hid_t dataset = H5Dopen2(opened, name.c_str(), H5P_DEFAULT);
      ASSERT_GE(dataset, 0) << name;
      const hid_t space = H5Dget_space(dataset);
      const std::array<hsize_t, 2> coordinate = {at, 0};
      H5Sselect_elements(space, H5S_SELECT_SET, 1, coordinate.data());
      const hsize_t one = 1;
      const hid_t memory = H5Screate_simple(1, &one, nullptr);
      EXPECT_GE(H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, &value), 0);
      H5Sclose(memory);
      H5Sclose(space);
      H5Dclose(dataset);
    });
  }
};
INSTANTIATE_TEST_SUITE_P(Artifact, Damage, kAllKinds, kKindNames);

TEST_P(Damage, TruncatedFilesAreRefused) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const std::string bytes = bytes_of(file("a.hdf"));
  for (const double share : {0.0, 0.001, 0.1, 0.5, 0.9, 0.999}) {
    put_bytes(file("a.hdf"),
              bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    refusal(GetParam(), values);
  }
}

/// A flipped bit is noticed, unless it lies where the format keeps nothing.
TEST_P(Damage, FlippedBitsNeverChangeWhatIsRead) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const std::string bytes = bytes_of(file("a.hdf"));
  std::mt19937_64 random(11);
  int refused = 0;
  constexpr int kFlips = 200;
  for (int i = 0; i < kFlips; ++i) {
    std::string damaged = bytes;
    char& byte = damaged[random() % damaged.size()];
    byte = static_cast<char>(byte ^ (1 << (random() % 8)));
    put_bytes(file("a.hdf"), damaged);
    try {
      EXPECT_TRUE(reads_equal(file("a.hdf"), GetParam(), values)) << "flip " << i;
    } catch (const InputError&) {
      ++refused;
    }
  }
  // Most of a file is data under checksums; of sizes, most is the surface that only viewers read.
  EXPECT_GT(refused, GetParam() == ArtifactKind::size ? kFlips / 10 : kFlips / 2);
}

/// Where a group's links are damaged, HDF5 must not free what it never set.
TEST_P(Damage, FlippedBitsInListsOfDatasetsDoNotCrash) {
  write(file("a.hdf"), GetParam(), make_values(), make_provenance());
  const std::string bytes = bytes_of(file("a.hdf"));
  ::mallopt(M_PERTURB, 0x5a);  // no memory is zero by chance
  int refused = 0;
  int tried = 0;
  // Blocks of HDF5 that hold names and the index of them.
  for (const std::string block : {"BTHD", "BTLF", "FRHP", "FHDB"}) {
    for (std::size_t at = bytes.find(block); at != std::string::npos;
         at = bytes.find(block, at + 1)) {
      for (const std::size_t behind : {5, 8, 11, 14, 17}) {
        std::string damaged = bytes;
        damaged.at(at + behind) = static_cast<char>(damaged.at(at + behind) ^ 4);
        put_bytes(file("a.hdf"), damaged);
        H5garbage_collect();
        ++tried;
        try {
          read_artifact_info(file("a.hdf"));
          check_picture(file("a.hdf"));
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
  }
  ::mallopt(M_PERTURB, 0);
  EXPECT_EQ(refused, tried);
}

TEST_P(Damage, OtherKindsAreRefusedByName) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  for (const ArtifactKind other :
       {ArtifactKind::mesh, ArtifactKind::tensor, ArtifactKind::field, ArtifactKind::lines,
        ArtifactKind::quads, ArtifactKind::tensor_part, ArtifactKind::size}) {
    if (other == GetParam()) continue;
    const std::string message = refusal(other, values);
    EXPECT_NE(message.find(kind_name(GetParam())), std::string::npos) << message;
    EXPECT_NE(message.find(kind_name(other)), std::string::npos) << message;
  }
}

TEST_P(Damage, NewerVersionsAreRefused) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  set_version(kFormatVersion + 1);
  EXPECT_NE(refusal(GetParam(), values).find("newer"), std::string::npos);
  EXPECT_THROW(read_artifact_info(file("a.hdf")), InputError);
}

// In the second, fields had a cross of their own for edges; all else was as it is.
TEST_F(Damage, FieldsOfOlderVersionsAreRead) {
  const Values values = make_values();
  write(file("a.hdf"), ArtifactKind::field, values, make_provenance());
  for (const int version : {1, 2}) {
    set_version(version);
    if (version == 2) {
      edit([&](hid_t opened) {
        H5Lcreate_hard(opened, "/field/cross", opened, "/field/detail", H5P_DEFAULT, H5P_DEFAULT);
      });
    }
    EXPECT_TRUE(reads_equal(file("a.hdf"), ArtifactKind::field, values));
  }
}

TEST_P(Damage, MissingDatasetsAreRefusedByName) {
  const Values values = make_values();
  write(file("a.hdf"), GetParam(), values, make_provenance());
  const std::string bytes = bytes_of(file("a.hdf"));
  for (const auto& dataset : read_artifact_info(file("a.hdf")).datasets) {
    put_bytes(file("a.hdf"), bytes);
    edit([&](hid_t opened) { H5Ldelete(opened, dataset.name.c_str(), H5P_DEFAULT); });
    EXPECT_NE(refusal(GetParam(), values).find(dataset.name), std::string::npos);
  }
}

TEST_F(Damage, IndicesOutOfRangeAndNumbersThatAreNoneAreRefused) {
  const Values values = make_values();
  const auto refuses = [&](ArtifactKind kind, const std::string& name, hsize_t at, hid_t type,
                           auto value) {
    write(file("a.hdf"), kind, values, make_provenance());
    set_scalar(name, at, type, value);
    EXPECT_NE(refusal(kind, values).find(name), std::string::npos) << name;
  };
  const Index vertices = values.mesh.vertex_count();
  const double nan = std::nan("");
  refuses(ArtifactKind::mesh, "/mesh/faces", 5, H5T_NATIVE_INT32, vertices);
  refuses(ArtifactKind::mesh, "/mesh/faces", 5, H5T_NATIVE_INT32, -1);
  refuses(ArtifactKind::mesh, "/mesh/twin", 0, H5T_NATIVE_INT32, 3 * values.mesh.face_count());
  refuses(ArtifactKind::mesh, "/mesh/twin", 3, H5T_NATIVE_INT32, 3);
  refuses(ArtifactKind::mesh, "/mesh/wedge_vertex", 0, H5T_NATIVE_INT32, vertices);
  refuses(ArtifactKind::mesh, "/mesh/source_vertex", 1, H5T_NATIVE_INT32, -5);
  refuses(ArtifactKind::mesh, "/mesh/source_face", 2, H5T_NATIVE_INT32, -2);
  refuses(ArtifactKind::mesh, "/mesh/positions", 7, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::mesh, "/mesh/is_corner", 2, H5T_NATIVE_INT32, 2);
  for (const double diagonal : {-1.0, 0.0, 1e-12, 1e30}) {
    refuses(ArtifactKind::mesh, "/mesh/diagonal", 0, H5T_NATIVE_DOUBLE, diagonal);
  }
  refuses(ArtifactKind::tensor, "/tensor/tensor", 4, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::field, "/field/k_min", 4, H5T_NATIVE_DOUBLE, 1 / 0.0);
  refuses(ArtifactKind::field, "/field/guide_face", 4, H5T_NATIVE_INT32, values.mesh.face_count());
  refuses(ArtifactKind::field, "/field/guide_offsets", 1, H5T_NATIVE_INT32, 0);
  refuses(ArtifactKind::field, "/field/guide_step", 4, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::field, "/field/guide_barycentric", 4, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::lines, "/lines/offsets", 1, H5T_NATIVE_INT32, -4);
  refuses(ArtifactKind::lines, "/lines/lambda", 1, H5T_NATIVE_DOUBLE, 1.0);
  refuses(ArtifactKind::lines, "/lines/halfedge", 1, H5T_NATIVE_INT32, -1);
  refuses(ArtifactKind::lines, "/lines/family", 1, H5T_NATIVE_INT32, 4);
  refuses(ArtifactKind::lines, "/lines/end_reason", 1, H5T_NATIVE_INT32, 7);
  refuses(ArtifactKind::lines, "/lines/seed_point", 1, H5T_NATIVE_INT32, 1000000);
  refuses(ArtifactKind::quads, "/quads/corners", 3, H5T_NATIVE_INT32, 40);
  refuses(ArtifactKind::quads, "/quads/offsets", 1, H5T_NATIVE_INT32, 2);
  refuses(ArtifactKind::quads, "/quads/source_face", 1, H5T_NATIVE_INT32, -1);
  refuses(ArtifactKind::tensor_part, "/tensor_part/part", 0, H5T_NATIVE_INT32, 0);
  refuses(ArtifactKind::tensor_part, "/tensor_part/part", 0, H5T_NATIVE_INT32, 4);
  refuses(ArtifactKind::tensor_part, "/tensor_part/parts", 0, H5T_NATIVE_INT32, 0);
  refuses(ArtifactKind::tensor_part, "/tensor_part/wedge", 0, H5T_NATIVE_INT32, -1);
  refuses(ArtifactKind::tensor_part, "/tensor_part/wedge", 3, H5T_NATIVE_INT32, 1);
  refuses(ArtifactKind::tensor_part, "/tensor_part/position", 2, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::tensor_part, "/tensor_part/normal", 2, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::size, "/size/along", 2, H5T_NATIVE_DOUBLE, nan);
  refuses(ArtifactKind::size, "/size/across", 2, H5T_NATIVE_DOUBLE, 0.0);
  refuses(ArtifactKind::size, "/size/across", 3, H5T_NATIVE_DOUBLE, -1.0);
}

/// Whoever follows what a file names reads other files, or runs code of others.
TEST_F(Damage, WhatLiesElsewhereOrIsFilteredIsRefused) {
  const Values values = make_values();
  const char* name = "/size/along";
  const hsize_t count = values.size.along.size();
  const auto refuses = [&](const char* part, const std::function<void(hid_t)>& change) {
    write(file("a.hdf"), ArtifactKind::size, values, make_provenance());
    edit([&](hid_t opened) {
      ASSERT_GE(H5Lmove(opened, name, opened, "/moved", H5P_DEFAULT, H5P_DEFAULT), 0);
      change(opened);
    });
    const std::string said = refusal(ArtifactKind::size, values);
    EXPECT_NE(said.find(std::string("'") + name + "' " + part), std::string::npos) << said;
  };
  const auto refuses_dataset = [&](const char* part, hid_t type,
                                   const std::function<void(hid_t, hid_t)>& set) {
    refuses(part, [&](hid_t opened) {
      const hid_t space = H5Screate_simple(1, &count, nullptr);
      const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
      set(creation, space);
      const hid_t dataset =
          H5Dcreate2(opened, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
      ASSERT_GE(dataset, 0);
      if (type == H5T_IEEE_F64LE) {
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 values.size.along.data());
      }
      H5Dclose(dataset);
      H5Pclose(creation);
      H5Sclose(space);
    });
  };
  write(file("b.hdf"), ArtifactKind::size, values, make_provenance());
  refuses("is missing", [&](hid_t opened) {
    H5Lcreate_external(file("b.hdf").c_str(), name, opened, name, H5P_DEFAULT, H5P_DEFAULT);
  });
  refuses("is missing",
          [&](hid_t opened) { H5Lcreate_soft("/moved", opened, name, H5P_DEFAULT, H5P_DEFAULT); });
  refuses_dataset("is in another file", H5T_IEEE_F64LE, [&](hid_t creation, hid_t) {
    H5Pset_external(creation, file("c.raw").c_str(), 0, count * sizeof(double));
  });
  refuses_dataset("is put together", H5T_IEEE_F64LE, [&](hid_t creation, hid_t space) {
    H5Pset_virtual(creation, space, file("b.hdf").c_str(), name, space);
  });
  const hsize_t one = 1;  // so small that compressing makes it larger; the other makes it smaller
  for (const hsize_t* chunk : {&one, &count}) {
    refuses_dataset("is compressed (gzip)", H5T_IEEE_F64LE, [&](hid_t creation, hid_t) {
      H5Pset_chunk(creation, 1, chunk);
      if (chunk == &count) H5Pset_shuffle(creation);
      H5Pset_deflate(creation, 9);
    });
  }
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, H5T_VARIABLE);
  refuses_dataset("has a wrong number type", text, [](hid_t, hid_t) {});
  H5Tclose(text);
}

/// Texts as other programs write them.
TEST_P(Damage, TextsInUtf8AreRead) {
  const Values values = make_values();
  const auto write_as_utf8 = [&](bool has_length) {
    write(file("a.hdf"), GetParam(), values, make_provenance());
    edit([&](hid_t opened) {
      for (const char* name : {"kind", "mesh_id", "content", "provenance"}) {
        const hid_t before = H5Aopen(opened, name, H5P_DEFAULT);
        const hid_t fixed = H5Aget_type(before);
        std::string text(H5Tget_size(fixed), ' ');
        ASSERT_GE(H5Aread(before, fixed, text.data()), 0);
        H5Aclose(before);
        H5Adelete(opened, name);
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, has_length ? text.size() : H5T_VARIABLE);
        H5Tset_cset(type, H5T_CSET_UTF8);
        const hid_t space = H5Screate(H5S_SCALAR);
        const hid_t after = H5Acreate2(opened, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        const char* characters = text.c_str();
        const void* data = &characters;
        ASSERT_GE(H5Awrite(after, type, has_length ? characters : data), 0);
        H5Aclose(after);
        H5Sclose(space);
        H5Tclose(type);
        H5Tclose(fixed);
      }
    });
  };
  write_as_utf8(true);
  EXPECT_TRUE(reads_equal(file("a.hdf"), GetParam(), values));
  write_as_utf8(false);
  const std::string said = refusal(GetParam(), values);
  EXPECT_NE(said.find("'kind' is a text of variable length"), std::string::npos) << said;
}

TEST_F(Damage, BlocksOfADamagedMeshAreRefused) {
  const Values values = make_values();
  const Index faces = values.mesh.face_count();
  const auto refuses = [&](const std::string& name, hsize_t at, hid_t type, auto value,
                           const auto& read) {
    write(file("a.hdf"), ArtifactKind::mesh, values, make_provenance());
    read(*open_tri_mesh(file("a.hdf")));
    set_scalar("/mesh/" + name, at, type, value);
    EXPECT_THROW(read(*open_tri_mesh(file("a.hdf"))), InputError) << name;
  };
  refuses("diagonal", 0, H5T_NATIVE_DOUBLE, -1.0, [](const MeshBlocks& /*mesh*/) {});
  refuses("positions", 7, H5T_NATIVE_DOUBLE, std::nan(""),
          [](const MeshBlocks& mesh) { (void)mesh.positions(5, 10); });
  refuses("wedge_vertex", 7, H5T_NATIVE_INT32, values.mesh.vertex_count(),
          [](const MeshBlocks& mesh) { (void)mesh.wedge_vertex(5, 10); });
  refuses("faces", 3 * 7, H5T_NATIVE_INT32, -1,
          [](const MeshBlocks& mesh) { (void)mesh.faces(5, 10); });
  refuses("face_wedges", 7, H5T_NATIVE_INT32, values.mesh.wedge_count(),
          [](const MeshBlocks& mesh) { (void)mesh.face_wedges(5, 10); });
  refuses("twin", 3 * 7, H5T_NATIVE_INT32, 3 * faces,
          [](const MeshBlocks& mesh) { (void)mesh.twin(5, 10); });
  refuses("is_feature", 3 * 7, H5T_NATIVE_INT32, 2,
          [](const MeshBlocks& mesh) { (void)mesh.is_feature(5, 10); });
}

TEST_F(Damage, FilesThatAreNoArtifactsAreRefused) {
  const Values values = make_values();
  put_bytes(file("a.hdf"), "ply\nformat ascii 1.0\n");
  refusal(ArtifactKind::mesh, values);
  fs::remove(file("a.hdf"));
  EXPECT_NE(refusal(ArtifactKind::mesh, values).find("no such file"), std::string::npos);
  const hid_t foreign = H5Fcreate(file("a.hdf").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(foreign);
  refusal(ArtifactKind::mesh, values);
}

}  // namespace
}  // namespace strake::artifact_test
