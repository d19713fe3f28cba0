#pragma once

#include <cstdint>

namespace strake::hdf5 {

/// Has HDF5 write a new file through system calls whose failures it does not hear of: of a write
/// that fails, HDF5 1.10 keeps the file, tries again, and crashes, at the latest when the program
/// ends. After a failure nothing more is written, and what HDF5 reads there is zero.
///
/// \param access  property list for H5Fcreate, an hid_t
/// \param error   set to the errno of the first failure; must outlive the file. Is to be looked at
///                after closing the file, which is sound only if it is 0.
/// \return whether HDF5 took it
bool set_output_driver(std::int64_t access, int* error);

}  // namespace strake::hdf5
