// SPDX-License-Identifier: GPL-3.0-or-later
// Output files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace palpate::cli {

/// A file written under a temporary name beside its target. Nothing is seen under the target's name
/// before commit(); without it the destructor removes the temporary file. Several outputs of one
/// command are all prepared first, then committed.
///
/// A symbolic link is followed: the file it names is replaced. A target that exists and is no
/// regular file (a device, a pipe) is written to in place, at commit().
class OutputFile {
 public:
  /// Writes and syncs the bytes. They must live until commit(). Throws Failure(kOther).
  OutputFile(std::filesystem::path target, std::span<const std::byte> bytes);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Renames to the target and syncs its folder; once. Throws Failure(kOther).
  void commit();

 private:
  std::filesystem::path target_;
  std::span<const std::byte> bytes_;
  std::filesystem::path temporary_;  // empty where the target is written in place
};

}  // namespace palpate::cli
