// Memory of programs: large blocks in large pages. Arrays of a million elements are written once
// and freed a hundred times a run; with pages of 4 KB the kernel spends a tenth of it on handing
// them out. Linked into programs only, so that a library never decides this for others.

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
/// Blocks from which on it is done; a part of a page at the end stays in small ones, so that no
/// memory is taken that is not asked for.
constexpr std::size_t kLargeBlock = 2 * kHugePage;

/// Gives large blocks back to the system as soon as they are freed: left among others, whose places
/// are not aligned, they would take a fifth more memory. Less than one at the end of the heap stays
/// for what comes next: taken in anew, page by page, it cost small runs a fifth of their time.
[[maybe_unused]] const int kIsSetUp = mallopt(M_MMAP_THRESHOLD, static_cast<int>(kLargeBlock)) +
                                      mallopt(M_TRIM_THRESHOLD, static_cast<int>(kLargeBlock));

void* allocate(std::size_t size) {
  if (size < kLargeBlock) return std::malloc(std::max<std::size_t>(size, 1));
  void* block = nullptr;
  if (posix_memalign(&block, kHugePage, size) != 0) return nullptr;
  // A hint: where the kernel has no such pages nothing changes.
  static_cast<void>(madvise(block, size / kHugePage * kHugePage, MADV_HUGEPAGE));
  return block;
}

}  // namespace

// NOLINTBEGIN(misc-new-delete-overloads): the others call these.
void* operator new(std::size_t size) {
  while (true) {
    if (void* block = allocate(size)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t /*size*/) noexcept { std::free(block); }
// NOLINTEND(misc-new-delete-overloads)
