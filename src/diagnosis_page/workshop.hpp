// An effect in words for the workshop: what it is, and what to check on the joint.
#pragma once

#include <string>
#include <vector>

#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {

/// (name of an effect) => (its words). A name from another version of the catalogue is its own word.
effects::WorkshopWords workshop_words(const std::string& effect);

/// (names) => "play in the gear and dry friction".
std::string in_workshop_words(const std::vector<std::string>& effects, const std::string& last_joint = " and ");

}  // namespace pmg::diagnosis_page
