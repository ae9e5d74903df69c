// SPDX-License-Identifier: Apache-2.0
#include "config/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>

namespace palpate::config {

std::error_code read_text(const std::filesystem::path& file, std::string& out_text) {
  const auto reason = [] { return std::error_code(errno, std::generic_category()); };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) return reason();
  out_text.clear();
  // Not sized beforehand: pipes and /dev/stdin have no size.
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, in.get()))
    out_text.append(block, n);
  return std::ferror(in.get()) ? reason() : std::error_code();
}

}  // namespace palpate::config
