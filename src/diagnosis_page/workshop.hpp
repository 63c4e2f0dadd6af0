// An effect in words for the workshop: what it is, and what to check on the joint.
#pragma once

#include <string>
#include <vector>

namespace pmg::diagnosis_page {

struct WorkshopWords {
  std::string what;   ///< the effect as a noun, without the words of control theory: "play in the gear"
  std::string check;  ///< what to do at the joint: whole sentences
  std::string cost;   ///< what the robot suffers from it: a whole sentence
};

/// (name of an effect) => (its words). A name from another version of the catalogue is its own word.
WorkshopWords workshop_words(const std::string& effect);

/// (names) => "play in the gear and dry friction".
std::string in_workshop_words(const std::vector<std::string>& effects, const std::string& last_joint = " and ");

}  // namespace pmg::diagnosis_page
