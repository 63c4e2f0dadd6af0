#include "diagnosis/options.hpp"

#include <utility>

namespace pmg::diagnosis {

evidence::ThresholdRows rows(JointDiagnosisOptions& joint, data_faults::DataFaultOptions& data) {
  evidence::ThresholdRows all = evidence::rows(joint);
  for (evidence::ThresholdRow& row : evidence::rows(data, "data_faults.")) all.push_back(std::move(row));
  return all;
}

}  // namespace pmg::diagnosis
