// SPDX-License-Identifier: Apache-2.0
// Text files in, whole.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace palpate::config {

/// The file's bytes. Where it cannot be read (absent, a folder, no permission) out_text is
/// unspecified.
[[nodiscard]] std::error_code read_text(const std::filesystem::path& file, std::string& out_text);

}  // namespace palpate::config
