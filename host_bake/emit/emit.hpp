// SPDX-License-Identifier: GPL-3.0-or-later
// An image in the forms that firmware tools take: C source, Intel HEX, ELF object. All are pure
// functions of their arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::bake {

/// C11 or C++11 source that defines, 64-byte aligned and with C linkage,
///   const unsigned char SYMBOL[N] = {...};
///   const unsigned long SYMBOL_size = N;
/// @param image    a validated image; its version and hash stand in the comment at the top
/// @param symbol   a C identifier
/// @param section  linker section of the array, or empty: the compiler's choice
std::string to_c_array(std::span<const std::byte> image, std::string_view symbol,
                       std::string_view section);

/// Intel HEX with extended linear addresses (record types 00, 01, 04), 16 bytes a record.
/// @param address  of the first byte; address + size must not pass 2^32
std::string to_intel_hex(std::span<const std::byte> bytes, std::uint32_t address);

enum class Machine { x86_64, aarch64, arm };

/// A relocatable little-endian ELF object, ELF32 for arm, with the bytes in a read-only section of
/// their own, 64-byte aligned, and three global symbols:
///   extern const unsigned char SYMBOL_start[], SYMBOL_end[];
///   extern const unsigned long SYMBOL_size;
/// The size is an object, not an absolute symbol: position-independent code can read it.
/// @param bytes  shorter than 2^32 for arm
std::vector<std::byte> to_elf_object(std::span<const std::byte> bytes, Machine machine,
                                     std::string_view section, std::string_view symbol);

}  // namespace palpate::bake
