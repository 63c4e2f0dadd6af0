// What differs from assembly to assembly, on a diagnosis' page.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// "Its zero offset differs from one arm to the next." for each parameter that differs; "" without any.
std::string differences_in_words(const diagnosis::Diagnosis& diagnosis);
/// What to do about the first of them: a sentence; "" without any.
std::string check_of_differences(const diagnosis::Diagnosis& diagnosis);

/// A table of each level's value, and what a simulation makes of it; nothing if all assemblies are alike.
void show_assemblies(pages::Page& page, const diagnosis::Diagnosis& diagnosis);

}  // namespace pmg::diagnosis_page
