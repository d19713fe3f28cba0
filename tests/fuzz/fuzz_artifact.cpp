// Artifacts of every kind that the HDF5 library has changed, as a stranger could: other values,
// sizes, types and ranks, datasets that are elsewhere or nowhere. What is read can be used, or it
// is refused. Files that HDF5 itself did not write are none of it: checksums refuse them.

#include <fuzzer/FuzzedDataProvider.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/core/error.h"
#include "common/core/observer.h"
#include "common/stage/value.h"
#include "stages/mesh/mesh.h"
#include "tests/artifacts/artifact_values.h"

namespace {

namespace fs = std::filesystem;
using strake::ArtifactKind;
using strake::PortKind;

constexpr std::array kKinds = {ArtifactKind::mesh,  ArtifactKind::tensor, ArtifactKind::field,
                               ArtifactKind::lines, ArtifactKind::quads,  ArtifactKind::tensor_part,
                               ArtifactKind::size};
constexpr std::array kPorts = {PortKind::mesh,  PortKind::tensor, PortKind::field,
                               PortKind::lines, PortKind::quads,  PortKind::tensor_part,
                               PortKind::size};

/// Sound artifacts as bytes, and a file to put changed ones into.
struct Sound {
  Sound() : folder(fs::temp_directory_path() / ("strake-fuzz-" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    values = strake::artifact_test::make_values();
    for (const ArtifactKind kind : kKinds) {
      strake::artifact_test::write(file(), kind, values, {});
      bytes[kind] = strake::artifact_test::bytes_of(file());
      for (const auto& dataset : strake::read_artifact_info(file()).datasets) {
        datasets[kind].push_back(dataset.name);
      }
    }
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Sound() { fs::remove_all(folder); }
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;
  [[nodiscard]] fs::path file() const { return folder / "a.hdf"; }

  fs::path folder;
  strake::artifact_test::Values values;
  std::map<ArtifactKind, std::string> bytes;
  std::map<ArtifactKind, std::vector<std::string>> datasets;
};

/// Values of a dataset along one axis that are still changed: what replaced one may be of any size,
/// and HDF5 gives it memory for all of it when it is written to.
constexpr hsize_t kMostValues = 1 << 16;

/// Changes a few scalars of a dataset, whatever its type.
void change_values(FuzzedDataProvider& data, hid_t file, const std::string& name) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (dataset < 0) return;
  const hid_t space = H5Dget_space(dataset);
  std::array<hsize_t, 2> size = {0, 1};
  if (H5Sget_simple_extent_ndims(space) <= 2) {
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
  }
  const hid_t memory = H5Screate(H5S_SCALAR);
  const bool has_values =
      std::ranges::all_of(size, [](hsize_t n) { return n > 0 && n <= kMostValues; });
  for (int n = data.ConsumeIntegralInRange(1, 4); n > 0 && has_values; --n) {
    const std::array<hsize_t, 2> at = {data.ConsumeIntegralInRange<hsize_t>(0, size[0] - 1),
                                       data.ConsumeIntegralInRange<hsize_t>(0, size[1] - 1)};
    H5Sselect_elements(space, H5S_SELECT_SET, 1, at.data());
    if (data.ConsumeBool()) {
      const double value = data.ConsumeFloatingPoint<double>();
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value);
    } else {
      const auto value = data.ConsumeBool() ? data.ConsumeIntegralInRange<std::int64_t>(-2, 400)
                                            : data.ConsumeIntegral<std::int64_t>();
      H5Dwrite(dataset, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, &value);
    }
  }
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(dataset);
}

/// Puts another dataset in the place of one: of any type, rank and size, perhaps never written.
void replace(FuzzedDataProvider& data, hid_t file, const std::string& name) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, H5T_VARIABLE);
  const hid_t type = data.PickValueInArray(
      {H5T_STD_I32LE, H5T_IEEE_F64LE, H5T_STD_U8LE, H5T_STD_I64LE, H5T_STD_I32BE, text});
  const int rank = data.ConsumeIntegralInRange(0, 3);
  std::array<hsize_t, 3> size = {1, 1, 1};
  const bool in_chunks = data.ConsumeBool();  // of which there can be only so many
  for (hsize_t& n : size) {
    n = data.PickValueInArray<hsize_t>({0, 1, 2, 3, 40, in_chunks ? 5U : hsize_t{1} << 40});
  }
  const hid_t space = H5Screate_simple(rank, size.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  const std::array<hsize_t, 3> chunk = {1, 1, 1};
  if (in_chunks) {
    H5Pset_chunk(creation, rank, chunk.data());
    if (data.ConsumeBool()) H5Pset_deflate(creation, 9);
  } else {
    switch (data.ConsumeIntegralInRange(0, 2)) {
      case 0:
        H5Pset_external(creation, "/dev/null", 0, H5F_UNLIMITED);
        break;
      case 1:
        H5Pset_virtual(creation, space, "/dev/null", "there", space);
        break;
      default:  // never written
        break;
    }
  }
  const hid_t dataset =
      H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (dataset >= 0) H5Dclose(dataset);
  H5Pclose(creation);
  if (space >= 0) H5Sclose(space);
  H5Tclose(text);
}

/// Puts a link in the place of a dataset.
void divert(FuzzedDataProvider& data, hid_t file, const std::string& name,
            const std::string& other) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  switch (data.ConsumeIntegralInRange(0, 3)) {
    case 0:
      H5Lcreate_external("/dev/null", "/there", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 1:
      H5Lcreate_soft(name.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 2:
      H5Lcreate_hard(file, other.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    default:
      H5Lcreate_hard(file, "/", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

void change_attribute(FuzzedDataProvider& data, hid_t file) {
  const char* name = data.PickValueInArray({"kind", "mesh_id", "provenance", "format_version"});
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  if (attribute < 0) return;
  const hid_t type = H5Aget_type(attribute);
  std::vector<char> value(H5Tget_size(type));
  H5Aread(attribute, type, value.data());
  if (!value.empty()) {
    value[data.ConsumeIntegralInRange<std::size_t>(0, value.size() - 1)] =
        data.ConsumeIntegral<char>();
  }
  H5Awrite(attribute, type, value.data());
  H5Tclose(type);
  H5Aclose(attribute);
}

/// The bytes of an artifact after some changes.
std::string changed(FuzzedDataProvider& data, const std::string& sound,
                    const std::vector<std::string>& datasets) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 16, false);
  std::string image = sound;
  H5Pset_file_image(access, image.data(), image.size());
  const hid_t file = H5Fopen("in memory", H5F_ACC_RDWR, access);
  if (file < 0) std::abort();
  for (int n = data.ConsumeIntegralInRange(1, 4); n > 0; --n) {
    const std::string& name =
        datasets[data.ConsumeIntegralInRange<std::size_t>(0, datasets.size() - 1)];
    switch (data.ConsumeIntegralInRange(0, 7)) {
      case 0:
        replace(data, file, name);
        break;
      case 1:
        divert(data, file, name, datasets.front());
        break;
      case 2:
        change_attribute(data, file);
        break;
      default:
        change_values(data, file, name);
    }
  }
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  image.resize(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
  H5Fget_file_image(file, image.data(), image.size());
  H5Fclose(file);
  H5Pclose(access);
  return image;
}

/// Does with a value what its indices must be good for.
void use(const Sound& sound, const strake::Value& value) {
  if (std::holds_alternative<strake::TriMesh>(value)) return;
  strake::check_belongs(sound.values.mesh, "mesh", value, "changed");
  if (const auto* lines = std::get_if<strake::LineSet>(&value)) {
    strake::SilentObserver observer;
    (void)strake::mesh_lines(sound.values.mesh, *lines, {}, observer);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const Sound sound;
  FuzzedDataProvider data(bytes, size);
  const auto kind = data.ConsumeIntegralInRange<std::size_t>(0, kKinds.size() - 1);
  strake::artifact_test::put_bytes(
      sound.file(), changed(data, sound.bytes.at(kKinds[kind]), sound.datasets.at(kKinds[kind])));
  try {
    (void)strake::read_artifact_info(sound.file());
    use(sound, strake::load_value(kPorts[kind], sound.file()));
  } catch (const strake::Error& error) {
    if (error.code() != strake::ExitCode::internal) return 0;  // refused
    std::fprintf(stderr, "found: %s\n", error.what());
    std::abort();
  }
  return 0;
}
