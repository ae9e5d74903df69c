// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/host_memory.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

namespace palpate::realtime {
namespace {

// Numbers of the Linux interface; older C library headers lack the names.
constexpr int kPopulateRead = 22;
constexpr int kPopulateWrite = 23;

/// A larger mapping is a reservation (a sanitizer's shadow), not memory.
constexpr std::uintptr_t kLargestMapping = std::uintptr_t(1) << 36;

struct Mapping {
  std::uintptr_t begin = 0, end = 0;
  bool writable = false;
};

std::vector<Mapping> readable_mappings() {
  std::vector<Mapping> mappings;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    Mapping m;
    char read = '-', write = '-';
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %c%c", &m.begin, &m.end, &read,
                    &write) != 4) {
      continue;
    }
    m.writable = write == 'w';
    if (read == 'r' && m.end - m.begin < kLargestMapping) mappings.push_back(m);
  }
  return mappings;
}

/// Whether the kernel knows how to. Single mappings refuse (those of devices and of the kernel's
/// own): the loop does not fault in them.
bool populate_all() {
  bool known = false;
  for (const Mapping& m : readable_mappings()) {
    const int advice = m.writable ? kPopulateWrite : kPopulateRead;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): addresses come as text from the kernel
    void* const begin = reinterpret_cast<void*>(m.begin);
    if (::madvise(begin, m.end - m.begin, advice) == 0) known = true;
  }
  return known;
}

std::string why(int error) {
  switch (error) {
    case EPERM:
      return "not permitted: raise the memlock limit, see `palpate doctor`";
    case ENOMEM:
      return "more than the memlock limit: raise it, see `palpate doctor`";
    case EAGAIN:
      return "some pages could not be locked: free some memory";
    default:
      return std::generic_category().message(error) + ": see `palpate doctor`";
  }
}

}  // namespace

HostMemory::HostMemory() : locked_(::mlockall(MCL_CURRENT) == 0) {
  if (locked_) return;
  problem_ = "memory not locked (" + why(errno) + ")";
  problem_ += populate_all() ? "; it is mapped, so only memory pressure can make it fault"
                             : "; nor mapped ahead (Linux 5.14 or later can)";
}

HostMemory::~HostMemory() {
  if (locked_) ::munlockall();
}

}  // namespace palpate::realtime
