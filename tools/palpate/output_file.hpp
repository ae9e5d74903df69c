// SPDX-License-Identifier: GPL-3.0-or-later
// Output files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace palpate::cli {

/// A file written under a temporary name beside its target. Nothing is seen under the target's name
/// before commit(); without it the destructor removes the temporary file. Several outputs of one
/// command are all written first, then committed.
///
/// A symbolic link is followed: the file it names is replaced. A target that exists and is no
/// regular file (a device, a pipe) is written to in place, as the bytes come.
class OutputFile {
 public:
  /// Throws Failure(kOther), as all members do.
  explicit OutputFile(std::filesystem::path target);
  OutputFile(std::filesystem::path target, std::span<const std::byte> bytes);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void append(std::span<const std::byte> bytes);
  void append(std::string_view text) { append(std::as_bytes(std::span(text))); }

  /// Syncs, renames to the target and syncs its folder; once, last.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;  // empty where the target is written in place
  int file_ = -1;
};

/// For what takes long: Failure(kOther) at its beginning where the file cannot be written at its
/// end. Nothing is left behind; pipes and devices are not touched.
void require_writable(const std::filesystem::path& target);

}  // namespace palpate::cli
