// What is looked at before HDF5 is asked to read something, and why it could not.
#pragma once
#include <hdf5.h>

#include <string>

namespace grainfield::dem::hdf5 {

/// To be called before any other call of HDF5: its error stack is not printed, it does not write
/// at the program's end, and links into other files are not followed.
void prepare();

/// Why this dataset is not read ("not numbers", "its data lie in another file", "larger than its
/// file"); empty: it may be read. An extent is bounded by what the file can hold.
std::string unreadable(hid_t dataset);
/// Size of the file that the object is in, bytes.
hsize_t file_size(hid_t object);

/// Why the last call of HDF5 failed.
bool checksum_failed();
bool out_of_memory();
/// errno of the system call in it that failed for a reason of the moment (means_cannot_read_now);
/// 0: none did.
int error_of_the_moment();

}  // namespace grainfield::dem::hdf5
