// SPDX-License-Identifier: GPL-3.0-or-later
// The pages that show a report or a live run: built from tools/report by the target
// `report_bundle`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace palpate::cli {

/// Where the page lies: `report.html` beside the executable (a build) or in ../share/palpate (an
/// installation). Throws Failure(kOther) where there is none, naming what built it would need.
std::filesystem::path report_page();

/// The same for `live.html`.
std::filesystem::path live_page();

/// The page with the data in the place that it holds for it. The data cannot end the element that
/// they stand in, whatever names they hold. Throws Failure(kOther) where the page cannot be read or
/// does not hold exactly one such place.
std::string fill_page(const std::filesystem::path& page, const nlohmann::ordered_json& data);

}  // namespace palpate::cli
