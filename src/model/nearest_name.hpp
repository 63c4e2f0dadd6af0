// What somebody probably meant who wrote a name that isn't known.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::model {

/// Edits that turn one word into the other: a letter inserted, left out or replaced, or two neighbours swapped. Upper
/// and lower case count as the same letter. The restricted Damerau-Levenshtein distance ("optimal string alignment").
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of these names; empty when none is near. Near is an edit for every three letters, and one at the least,
/// or a beginning that only one name has.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// The file in the same folder, with the same ending, whose name is nearest; empty when none is near.
std::filesystem::path nearest_file(const std::filesystem::path& file);

/// How an error goes on after an unknown name: "did you mean NAME?", or when none is near "expected one of A, B, C".
std::string expected_name(std::string_view name, const std::vector<std::string>& names);

}  // namespace pmg::model
