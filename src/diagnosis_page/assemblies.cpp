#include "diagnosis_page/assemblies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assembly/parameters.hpp"

namespace pmg::diagnosis_page {

std::string differences_in_words(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> sentences;
  for (const assembly::Variation& one : diagnosis.assemblies.varies) {
    sentences.push_back(fmt::format("Its {} differs from assembly to assembly, by column {} of runs.csv.",
                                    assembly::title(one.parameter), assembly::columns_text(one.columns)));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string check_of_differences(const diagnosis::Diagnosis& diagnosis) {
  const std::vector<assembly::Variation>& varies = diagnosis.assemblies.varies;
  if (varies.empty()) return "";
  return fmt::format("In each assembly, {}.", assembly::check(varies.front().parameter));
}

void show_assemblies(pages::Page& page, const diagnosis::Diagnosis& diagnosis) {
  const assembly::AssemblyDifferences& found = diagnosis.assemblies;
  if (found.varies.empty()) return;
  page.heading("What differs from assembly to assembly");
  for (const assembly::Variation& one : found.varies) {
    page.paragraph(fmt::format("{} To find out why: {}.", assembly::sentence(one, assembly::Levels::kInTable),
                               assembly::check(one.parameter)));
    pages::Table table{.header = {fmt::format("{}", fmt::join(one.columns, " or ")), "recordings",
                                  assembly::title(one.parameter) + ", with 95 % interval"},
                       .rows = {}};
    for (const assembly::LevelValue& level : one.levels)
      table.rows.push_back({level.level, fmt::format("{}", level.runs), assembly::value_text(one, level.value)});
    page.table(table);
    page.paragraph(
        fmt::format("motor.yaml has the mean over assemblies. Which value another assembly has is not known: for "
                    "training draw from a normal distribution with {}.",
                    assembly::spread_text(one)));
  }
}

}  // namespace pmg::diagnosis_page
