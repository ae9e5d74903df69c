// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/emit/emit.hpp"

#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "hal/flash/dfu_suffix.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/signing.hpp"

namespace palpate::cli {
namespace {

struct EmitOptions {
  std::filesystem::path image;
  std::filesystem::path out;
  std::string form;
  std::string symbol = "palpate_image";
  std::string section;
  std::string machine = "x86_64";
  std::uint32_t address = 0;
  hal::flash::DfuSuffix suffix;
  SignOptions sign;
};

bool is_word(const std::string& text, std::string_view also) {
  for (const char c : text) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (!letter && also.find(c) == std::string_view::npos) return false;
  }
  return !text.empty();
}

// An option that the form has no use for is a mistake, not a wish.
void check_options(const CLI::App& command, const std::string& form) {
  constexpr struct {
    const char* name;
    std::string_view forms;
  } kOptions[] = {{"--symbol", "c elf"}, {"--section", "c elf"}, {"--address", "hex"},
                  {"--machine", "elf"},  {"--vendor-id", "dfu"}, {"--product-id", "dfu"},
                  {"--sign", "dfu"},     {"--counter", "dfu"}};
  for (const auto& option : kOptions) {
    if (command.count(option.name) > 0 && option.forms.find(form) == std::string_view::npos) {
      throw Failure(kUsage, "option has no meaning for this form",
                    std::string(option.name) + " with --as " + form, "leave it out");
    }
  }
}

void check_names(const EmitOptions& options) {
  const bool starts_with_digit =
      !options.symbol.empty() && std::isdigit(static_cast<unsigned char>(options.symbol[0])) != 0;
  if (!is_word(options.symbol, "_") || starts_with_digit) {
    throw Failure(kUsage, "not a C identifier", "--symbol " + options.symbol,
                  "use letters, digits and _, a letter or _ first");
  }
  if (!options.section.empty() && !is_word(options.section, "_.$-")) {
    throw Failure(kUsage, "not a section name", "--section " + options.section,
                  "use letters, digits, and any of . _ $ -");
  }
}

void check_file(const EmitOptions& options) {
  const std::string file = options.out.string();
  const std::string wrong = wrong_name(file, "." + options.form);
  if (!wrong.empty()) throw CLI::ValidationError("--output", wrong);
}

void check_address(std::uint32_t address, std::size_t size) {
  const std::string where = "--address " + std::to_string(address);
  if (address % image::kAlignment != 0) {
    throw Failure(kUsage, "an image cannot be used at this address", where,
                  "give a multiple of " + std::to_string(image::kAlignment));
  }
  if (size > (std::uint64_t{1} << 32) - address) {
    throw Failure(kUsage, "the image ends above 4 GiB", where, "give a lower address");
  }
}

bake::Machine machine_of(const EmitOptions& options, std::size_t size) {
  if (options.machine == "aarch64") return bake::Machine::aarch64;
  if (options.machine == "x86_64") return bake::Machine::x86_64;
  if (size >> 31 != 0) {
    throw Failure(kUsage, "the image is too large for a 32-bit object", "--machine arm",
                  "bake a smaller image");
  }
  return bake::Machine::arm;
}

std::vector<std::byte> to_dfu_file(std::vector<std::byte> file,
                                   const hal::flash::DfuSuffix& suffix) {
  const auto tail = hal::flash::make_suffix(file, suffix);
  file.insert(file.end(), tail.begin(), tail.end());
  return file;
}

void emit(const EmitOptions& options) {
  check_names(options);
  const ImageFile image(options.image);
  const auto bytes = image.bytes();
  if (options.form == "c") {
    write_file(options.out, bake::to_c_array(bytes, options.symbol, options.section));
  } else if (options.form == "hex") {
    check_address(options.address, bytes.size());
    write_file(options.out, bake::to_intel_hex(bytes, options.address));
  } else if (options.form == "dfu") {
    write_file(options.out, to_dfu_file(with_signature(bytes, options.sign), options.suffix));
  } else {
    const std::string section = options.section.empty() ? ".palpate_image" : options.section;
    write_file(options.out, bake::to_elf_object(bytes, machine_of(options, bytes.size()), section,
                                                options.symbol));
  }
}

}  // namespace

void add_emit(CLI::App& app) {
  auto options = std::make_shared<EmitOptions>();
  CLI::App* command = app.add_subcommand(
      "emit",
      "Write an image as C source, Intel HEX, a linkable ELF object or a DFU file, byte for byte");
  command->add_option("IMAGE", options->image, "Image made by bake")->required();
  command->add_option("--as", options->form, "What to write")
      ->required()
      ->check(CLI::IsMember({"c", "hex", "elf", "dfu"}));
  command->add_option("-o,--output", options->out, "File to write")->required();
  command->add_option("--symbol", options->symbol, "c, elf: name of the symbols")
      ->capture_default_str();
  command->add_option("--section", options->section,
                      "c, elf: linker section (elf: .palpate_image where not given)");
  command->add_option("--address", options->address, "hex: address of the first byte")
      ->capture_default_str();
  command->add_option("--machine", options->machine, "elf: what the object is linked for")
      ->check(CLI::IsMember({"x86_64", "aarch64", "arm"}))
      ->capture_default_str();
  command
      ->add_option("--vendor-id", options->suffix.vendor,
                   "dfu: USB vendor that the file is for, 0xffff for any")
      ->capture_default_str();
  command
      ->add_option("--product-id", options->suffix.product,
                   "dfu: USB product that the file is for, 0xffff for any")
      ->capture_default_str();
  add_sign_options(*command, options->sign, "dfu: ");
  command->callback([command, options] {
    check_options(*command, options->form);
    check_file(*options);
    emit(*options);
  });
}

}  // namespace palpate::cli
