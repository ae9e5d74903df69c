// SPDX-License-Identifier: GPL-3.0-or-later
// System V ABI, Chapters 4 and 5: header, section contents, section headers.
#include <elf.h>

#include <array>
#include <cstring>

#include "host_bake/emit/emit.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

struct Elf32 {
  using Header = Elf32_Ehdr;
  using Section = Elf32_Shdr;
  using Symbol = Elf32_Sym;
  using Word = Elf32_Addr;  // unsigned long of the machine
  static constexpr unsigned char kClass = ELFCLASS32;
};

struct Elf64 {
  using Header = Elf64_Ehdr;
  using Section = Elf64_Shdr;
  using Symbol = Elf64_Sym;
  using Word = Elf64_Addr;
  static constexpr unsigned char kClass = ELFCLASS64;
};

enum SectionIndex : std::uint16_t {
  kNull,
  kImage,
  kSize,
  kStackNote,
  kSymbols,
  kSymbolNames,
  kSectionNames,
  kSections
};

// Strings that are named by the offset of their first byte; the empty one is at 0.
class StringTable {
 public:
  std::uint32_t add(std::string_view text) {
    const auto offset = static_cast<std::uint32_t>(bytes_.size());
    bytes_.append(text);
    bytes_ += '\0';
    return offset;
  }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return std::as_bytes(std::span(bytes_));
  }

 private:
  std::string bytes_ = std::string(1, '\0');
};

template <class Elf>
class ObjectWriter {
 public:
  explicit ObjectWriter(Elf64_Half machine) : out_(sizeof(typename Elf::Header)) {
    std::memcpy(header_.e_ident, ELFMAG, SELFMAG);
    header_.e_ident[EI_CLASS] = Elf::kClass;
    header_.e_ident[EI_DATA] = ELFDATA2LSB;
    header_.e_ident[EI_VERSION] = EV_CURRENT;
    header_.e_type = ET_REL;
    header_.e_machine = machine;
    header_.e_version = EV_CURRENT;
    header_.e_flags = machine == EM_ARM ? EF_ARM_EABI_VER5 : 0;
    header_.e_ehsize = sizeof(typename Elf::Header);
    header_.e_shentsize = sizeof(typename Elf::Section);
    header_.e_shnum = kSections;
    header_.e_shstrndx = kSectionNames;
  }

  typename Elf::Section& add(SectionIndex index, std::string_view name, std::uint32_t type,
                             std::size_t alignment, std::span<const std::byte> content) {
    return put(index, names_.add(name), type, alignment, content);
  }

  std::vector<std::byte> finish() && {
    const std::uint32_t own_name = names_.add(".shstrtab");
    put(kSectionNames, own_name, SHT_STRTAB, 1, names_.bytes());
    align(sizeof(typename Elf::Word));
    header_.e_shoff = static_cast<typename Elf::Word>(out_.size());
    const auto table = std::as_bytes(std::span(sections_));
    out_.insert(out_.end(), table.begin(), table.end());
    std::memcpy(out_.data(), &header_, sizeof(header_));
    return std::move(out_);
  }

 private:
  typename Elf::Section& put(SectionIndex index, std::uint32_t name, std::uint32_t type,
                             std::size_t alignment, std::span<const std::byte> content) {
    align(alignment);
    typename Elf::Section& section = sections_[index];
    section.sh_name = name;
    section.sh_type = type;
    section.sh_offset = static_cast<typename Elf::Word>(out_.size());
    section.sh_size = static_cast<typename Elf::Word>(content.size());
    section.sh_addralign = static_cast<typename Elf::Word>(alignment);
    out_.insert(out_.end(), content.begin(), content.end());
    return section;
  }

  void align(std::size_t alignment) {
    out_.resize((out_.size() + alignment - 1) / alignment * alignment);
  }

  typename Elf::Header header_{};
  std::array<typename Elf::Section, kSections> sections_{};
  StringTable names_;
  std::vector<std::byte> out_;
};

template <class Elf>
std::vector<std::byte> object(std::span<const std::byte> bytes, Elf64_Half machine,
                              std::string_view section, std::string_view symbol) {
  using Word = typename Elf::Word;
  ObjectWriter<Elf> writer(machine);
  writer.add(kImage, section, SHT_PROGBITS, image::kAlignment, bytes).sh_flags = SHF_ALLOC;

  const std::array<Word, 1> size = {static_cast<Word>(bytes.size())};
  const std::string size_section = ".rodata." + std::string(symbol) + "_size";
  writer.add(kSize, size_section, SHT_PROGBITS, sizeof(Word), std::as_bytes(std::span(size)))
      .sh_flags = SHF_ALLOC;
  // Without this note, linkers take it that the object wants an executable stack.
  writer.add(kStackNote, ".note.GNU-stack", SHT_PROGBITS, 1, {});

  StringTable names;
  std::array<typename Elf::Symbol, 4> symbols{};
  const auto set = [&](std::size_t i, const char* suffix, SectionIndex index, Word value,
                       Word length, unsigned char type) {
    symbols[i].st_name = names.add(std::string(symbol) + suffix);
    symbols[i].st_info = static_cast<unsigned char>(STB_GLOBAL << 4 | type);
    symbols[i].st_shndx = index;
    symbols[i].st_value = value;
    symbols[i].st_size = length;
  };
  set(1, "_start", kImage, 0, size[0], STT_OBJECT);
  set(2, "_end", kImage, size[0], 0, STT_NOTYPE);
  set(3, "_size", kSize, 0, sizeof(Word), STT_OBJECT);
  auto& table =
      writer.add(kSymbols, ".symtab", SHT_SYMTAB, sizeof(Word), std::as_bytes(std::span(symbols)));
  table.sh_link = kSymbolNames;
  table.sh_info = 1;  // the first global symbol
  table.sh_entsize = sizeof(typename Elf::Symbol);
  writer.add(kSymbolNames, ".strtab", SHT_STRTAB, 1, names.bytes());
  return std::move(writer).finish();
}

}  // namespace

std::vector<std::byte> to_elf_object(std::span<const std::byte> bytes, Machine machine,
                                     std::string_view section, std::string_view symbol) {
  switch (machine) {
    case Machine::arm:
      return object<Elf32>(bytes, EM_ARM, section, symbol);
    case Machine::aarch64:
      return object<Elf64>(bytes, EM_AARCH64, section, symbol);
    case Machine::x86_64:
      break;
  }
  return object<Elf64>(bytes, EM_X86_64, section, symbol);
}

}  // namespace palpate::bake
