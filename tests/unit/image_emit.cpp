// SPDX-License-Identifier: GPL-3.0-or-later
#include <elf.h>
#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"
#include "host_bake/emit/emit.hpp"

namespace palpate::bake {
namespace {

using test::AlignedBytes;

AlignedBytes some_image() {
  return test::seal(test::parts_of({test::tetrahedron_part(), test::ball_part(0.5f, 5, 8)}));
}

std::vector<std::byte> random_bytes(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random());
  return bytes;
}

unsigned hex_number(std::string_view text) {
  unsigned value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  EXPECT_EQ(result.ptr, text.data() + text.size()) << text;
  return value;
}

/// Address to byte, as the format's specification reads a file.
std::map<std::uint64_t, std::byte> read_hex(const std::string& text) {
  std::map<std::uint64_t, std::byte> memory;
  std::istringstream lines(text);
  std::uint64_t upper = 0;
  bool ended = false;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_FALSE(ended);
    EXPECT_EQ(line.at(0), ':');
    std::vector<unsigned> bytes;
    unsigned sum = 0;
    for (std::size_t i = 1; i < line.size(); i += 2) {
      bytes.push_back(hex_number(std::string_view(line).substr(i, 2)));
      sum += bytes.back();
    }
    EXPECT_EQ(sum % 256, 0u) << line;
    EXPECT_EQ(bytes.at(0) + 5, bytes.size()) << line;
    const unsigned low = bytes[1] * 256 + bytes[2];
    if (bytes[3] == 4) upper = std::uint64_t{bytes[4] * 256 + bytes[5]} << 16;
    if (bytes[3] == 1) ended = true;
    if (bytes[3] != 0) continue;
    for (unsigned i = 0; i < bytes[0]; ++i) {
      EXPECT_LT(low + i, 0x10000u);
      EXPECT_TRUE(memory.emplace(upper + low + i, static_cast<std::byte>(bytes[4 + i])).second);
    }
  }
  EXPECT_TRUE(ended);
  return memory;
}

TEST(IntelHex, ReadBack_gives_the_bytes_at_their_addresses) {
  for (const std::uint32_t address : {0u, 0x08000040u, 0x0000ffc0u, 0xfffe0000u - 0x3000u}) {
    const auto bytes = random_bytes(0x20000 + 13);
    const auto memory = read_hex(to_intel_hex(bytes, address));
    ASSERT_EQ(memory.size(), bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      ASSERT_EQ(memory.at(address + i), bytes[i]) << i;
    }
  }
}

TEST(IntelHex, KnownRecords_are_written_as_specified) {
  const std::array<std::byte, 3> bytes = {std::byte{0x02}, std::byte{0x33}, std::byte{0x7a}};
  EXPECT_EQ(to_intel_hex(bytes, 0x00010030),
            ":020000040001F9\n"
            ":0300300002337A1E\n"
            ":00000001FF\n");
}

TEST(CArray, Text_names_version_and_hash) {
  const std::string text = to_c_array(some_image(), "scan", "");
  EXPECT_NE(text.find("format 3.0"), std::string::npos);
  EXPECT_NE(text.find("SHA-256"), std::string::npos);
  EXPECT_EQ(text.find("section"), std::string::npos);
  EXPECT_NE(to_c_array(some_image(), "scan", ".flash").find("section(\".flash\")"),
            std::string::npos);
}

template <class T>
T record_at(std::span<const std::byte> bytes, std::size_t offset) {
  T record;
  EXPECT_LE(offset + sizeof(T), bytes.size());
  std::memcpy(&record, bytes.data() + offset, sizeof(T));
  return record;
}

std::string string_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::string text;
  for (; bytes[offset] != std::byte{0}; ++offset) text += static_cast<char>(bytes[offset]);
  return text;
}

/// Reads an object as a linker would: sections by name, and symbols as {section's name, value}.
template <class Header, class Section, class Symbol>
struct ObjectReader {
  explicit ObjectReader(std::span<const std::byte> bytes) : header(record_at<Header>(bytes, 0)) {
    const auto section_at = [&](std::size_t i) {
      return record_at<Section>(bytes, header.e_shoff + i * sizeof(Section));
    };
    const Section names = section_at(header.e_shstrndx);
    const auto name_of = [&](std::size_t i) {
      return string_at(bytes, names.sh_offset + section_at(i).sh_name);
    };
    for (std::size_t i = 1; i < header.e_shnum; ++i) {
      const Section section = section_at(i);
      sections[name_of(i)] = section;
      if (section.sh_type != SHT_SYMTAB) continue;
      for (std::size_t at = sizeof(Symbol); at < section.sh_size; at += sizeof(Symbol)) {
        const auto symbol = record_at<Symbol>(bytes, section.sh_offset + at);
        symbols[string_at(bytes, section_at(section.sh_link).sh_offset + symbol.st_name)] = {
            name_of(symbol.st_shndx), symbol.st_value};
      }
    }
  }

  Header header;
  std::map<std::string, Section> sections;
  std::map<std::string, std::pair<std::string, std::uint64_t>> symbols;
};

template <class Reader>
void expect_object(Machine machine, unsigned char elf_class, unsigned elf_machine) {
  const AlignedBytes image = some_image();
  const auto bytes = to_elf_object(image, machine, ".own", "scan");
  const Reader object{std::span<const std::byte>(bytes)};
  EXPECT_EQ(std::memcmp(object.header.e_ident, ELFMAG, SELFMAG), 0);
  EXPECT_EQ(object.header.e_ident[EI_CLASS], elf_class);
  EXPECT_EQ(object.header.e_machine, elf_machine);
  EXPECT_EQ(object.header.e_type, ET_REL);

  const auto& own = object.sections.at(".own");
  ASSERT_EQ(own.sh_size, image.size());
  EXPECT_EQ(own.sh_addralign, 64u);
  EXPECT_EQ(own.sh_flags, static_cast<unsigned>(SHF_ALLOC));
  EXPECT_EQ(std::memcmp(bytes.data() + own.sh_offset, image.data(), image.size()), 0);

  const std::pair<std::string, std::uint64_t> start = {".own", 0};
  const std::pair<std::string, std::uint64_t> end = {".own", image.size()};
  EXPECT_EQ(object.symbols.size(), 3u);
  EXPECT_EQ(object.symbols.at("scan_start"), start);
  EXPECT_EQ(object.symbols.at("scan_end"), end);
  const auto& size = object.sections.at(object.symbols.at("scan_size").first);
  EXPECT_EQ(size.sh_size, elf_class == ELFCLASS32 ? 4u : 8u);
  EXPECT_EQ(record_at<std::uint32_t>(bytes, size.sh_offset), image.size());
}

TEST(ElfObject, Sections_and_symbols_are_those_promised_for_each_machine) {
  using Reader32 = ObjectReader<Elf32_Ehdr, Elf32_Shdr, Elf32_Sym>;
  using Reader64 = ObjectReader<Elf64_Ehdr, Elf64_Shdr, Elf64_Sym>;
  expect_object<Reader64>(Machine::x86_64, ELFCLASS64, EM_X86_64);
  expect_object<Reader64>(Machine::aarch64, ELFCLASS64, EM_AARCH64);
  expect_object<Reader32>(Machine::arm, ELFCLASS32, EM_ARM);
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {static_cast<const char*>(static_cast<const void*>(bytes.data())), bytes.size()};
}

/// A folder, and the tools in it that a firmware build would use.
class EmitLink : public testing::Test {
 protected:
  void write(const std::string& name, std::string_view text) const { folder_.write(name, text); }
  [[nodiscard]] std::string read(const std::string& name) const {
    return test::read_file(folder_.path() / name);
  }
  [[nodiscard]] int run(const std::string& command) const {
    return std::system(("cd '" + folder_.path().string() + "' && " + command).c_str());
  }

  AlignedBytes image_ = some_image();
  test::TemporaryFolder folder_;
};

constexpr const char* kCArrayProgram = R"(
extern const unsigned char scan[];
extern const unsigned long scan_size;
#include <stdint.h>
#include <stdio.h>
int main(void) {
  if ((uintptr_t)scan % 64 != 0) return 1;
  return fwrite(scan, 1, scan_size, stdout) == scan_size ? 0 : 2;
}
)";

TEST_F(EmitLink, CArray_compiled_as_C_equals_the_image) {
  write("scan.c", to_c_array(image_, "scan", ""));
  write("main.c", kCArrayProgram);
  ASSERT_EQ(run(PALPATE_CC " -std=c11 -Wall -Wextra -Wpedantic -Werror scan.c main.c -o program"),
            0);
  ASSERT_EQ(run("./program > out.bin"), 0);
  EXPECT_EQ(read("out.bin"), as_text(image_));
}

TEST_F(EmitLink, CArray_compiled_as_Cxx_equals_the_image) {
  write("scan.cpp", to_c_array(image_, "scan", ".scan_flash"));
  write("main.c", kCArrayProgram);
  ASSERT_EQ(run(PALPATE_CXX " -std=c++11 -Wall -Wextra -Wpedantic -Werror -c scan.cpp"), 0);
  ASSERT_EQ(run(PALPATE_CC " -std=c11 scan.o main.c -o program && ./program > out.bin"), 0);
  EXPECT_EQ(read("out.bin"), as_text(image_));
}

constexpr const char* kElfProgram = R"(
extern const unsigned char scan_start[], scan_end[];
extern const unsigned long scan_size;
#include <stdint.h>
#include <stdio.h>
int main(void) {
  if ((uintptr_t)scan_start % 64 != 0) return 1;
  if ((unsigned long)(scan_end - scan_start) != scan_size) return 2;
  return fwrite(scan_start, 1, scan_size, stdout) == scan_size ? 0 : 3;
}
)";

TEST_F(EmitLink, ElfObject_linked_equals_the_image) {
#if defined(__x86_64__)
  const Machine machine = Machine::x86_64;
#elif defined(__aarch64__)
  const Machine machine = Machine::aarch64;
#else
  GTEST_SKIP() << "no ELF form for this host";
  const Machine machine = Machine::arm;
#endif
  write("scan.o", as_text(to_elf_object(image_, machine, ".palpate_image", "scan")));
  write("main.c", kElfProgram);
  for (const char* flags :
       {"-fPIE -pie", "-fno-pie -no-pie", "-fno-pie -no-pie -Wl,--gc-sections"}) {
    ASSERT_EQ(run(std::string(PALPATE_CC " -std=c11 -Wl,--fatal-warnings ") + flags +
                  " scan.o main.c -o program && ./program > out.bin"),
              0)
        << flags;
    EXPECT_EQ(read("out.bin"), as_text(image_)) << flags;
  }
}

TEST_F(EmitLink, IntelHex_converted_by_objcopy_equals_the_image) {
  write("image.hex", to_intel_hex(image_, 0x08040000));
  ASSERT_EQ(run("objcopy -I ihex -O binary image.hex out.bin"), 0);
  EXPECT_EQ(read("out.bin"), as_text(image_));
}

}  // namespace
}  // namespace palpate::bake
