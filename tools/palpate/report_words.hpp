// SPDX-License-Identifier: GPL-3.0-or-later
// A report's summary in words.
#pragma once

#include <string>
#include <vector>

#include "tools/palpate/report_input.hpp"

namespace palpate::cli {

/// What the input shows, the most important first: a sentence or two each, with units.
std::vector<std::string> summary_in_words(const ReportInput& input);

}  // namespace palpate::cli
