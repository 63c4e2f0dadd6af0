// A diagnosis in the words of a workshop: what is wrong with the joint, how sure that is, how much better the
// simulation gets, and what to do next.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// The first paragraph of the page: a few short sentences without a term of the field.
std::string first_paragraph(const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis);

/// What to check at the joint, for each cause and for what could be the cause instead. Nothing without causes.
void show_what_to_check(pages::Page& page, const diagnosis::Diagnosis& diagnosis);

}  // namespace pmg::diagnosis_page
