// The known name that is closest to an unknown one: a proposal for the error message.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::files {

/// Number of edits that turn one word into the other: a letter inserted, left out or replaced, or two neighbours
/// swapped. Upper and lower case are the same letter. This is the restricted Damerau-Levenshtein distance ("optimal
/// string alignment").
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of these names; empty if none is near. A name is near at up to one edit per three letters, but at least
/// one, or if it has the same parts in another order (knee_left), or if it alone begins with the given word.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// The nearest file of the same folder and ending; empty if none is near.
std::filesystem::path nearest_file(const std::filesystem::path& file);

/// The end of an error message after an unknown name: "did you mean NAME?" ("left_NAME or right_NAME": those with it as
/// a word, if they are few), or if none is near "expected one of A, B, C".
std::string expected_name(std::string_view name, const std::vector<std::string>& names);

}  // namespace pmg::files
