#include "data_faults/data_faults_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "evidence/thresholds.hpp"

namespace pmg::data_faults {

namespace {

using Json = nlohmann::ordered_json;

/// The number of the first correction: what a value is multiplied by; 1 where there is none.
double factor_of(const DataFault& fault) {
  if (fault.fixes.empty()) return 1.0;
  const bench::Correction& fix = fault.fixes.front();
  return fix.factor * fix.kp_factor * fix.kd_factor * fix.load_factor;
}

}  // namespace

work::Worth worth_of(const Examination& examination) {
  work::Worth worth;
  for (const DataFault& fault : examination.faults)
    worth.add(examination.uncorrected() ? work::Grade::kOffItsData : work::Grade::kOpen,
              fmt::format("fault of the data, {}: {}: {}", name(fault.kind), fault.where, fault.correction));
  return worth;
}

void add_to(Json& whole, const Examination& examination) {
  Json found = Json::array();
  for (const DataFault& fault : examination.faults) {
    Json json = {{"kind", name(fault.kind)},
                 {"where", fault.where},
                 {"correction", fault.correction},
                 {"evidence", fault.evidence}};
    json["runs"] = fault.files.empty() ? Json("all") : Json(fault.files);
    json["factor"] = factor_of(fault);
    json["shift_s"] = fault.fixes.empty() ? 0.0 : fault.fixes.front().shift_s;
    found.push_back(json);
  }
  whole["data_faults"] = found;
  whole["data_faults_handled"] = {{"by", name(examination.handling)},
                                  {"corrected", !examination.corrected.empty()},
                                  {"left_out", examination.left_out},
                                  {"readings_left_out", !examination.readings_left_out.empty()},
                                  {"verdict_of_faulty_data", examination.uncorrected()}};
  whole["data_fault_options"] = evidence::thresholds_json(examination.options);
}

std::string handling_text(const Examination& examination) {
  if (examination.faults.empty()) return "";
  if (examination.uncorrected())
    return "The verdict is of data with faults, as --data-faults keep asks for: don't trust it. Mend the files.";
  std::vector<std::string> sentences;
  if (!examination.left_out.empty())
    sentences.push_back(fmt::format("The verdict leaves out {} run{}: {}.", examination.left_out.size(),
                                    examination.left_out.size() > 1 ? "s" : "", fmt::join(examination.left_out, ", ")));
  if (!examination.readings_left_out.empty())
    sentences.push_back("The verdict leaves out the readings that stand still while the joint moves.");
  if (!examination.corrected.empty())
    sentences.push_back("The verdict is of the corrected data. The files are as they were: mend them.");
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string faults_text(const Examination& examination) {
  if (examination.faults.empty()) return "";
  std::string text = fmt::format("DATA FAULTS: {}\n", examination.faults.size());
  for (const DataFault& fault : examination.faults) {
    text += fmt::format("  {}: {}: {}\n", name(fault.kind), fault.where, fault.correction);
    for (const std::string& sentence : fault.evidence) text += fmt::format("    {}\n", sentence);
  }
  return text + "  " + handling_text(examination) + "\n";
}

void show_faults(pages::Page& page, const Examination& examination) {
  if (examination.faults.empty()) return;
  page.note(fmt::format("Data faults: {}. {}", examination.faults.size(), handling_text(examination)));
  pages::Table table{.header = {"fault", "where", "correction", "evidence"}, .rows = {}};
  for (const DataFault& fault : examination.faults) {
    table.rows.push_back(
        {name(fault.kind), fault.where, fault.correction, fmt::format("{}", fmt::join(fault.evidence, "; "))});
  }
  page.table(table);
}

}  // namespace pmg::data_faults
