// z1's committed policy for benchmarks of its cost. It loads with any clips, because its fit to today's clips doesn't
// matter here.
#pragma once

#include <onnxruntime_cxx_api.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "folders.hpp"
#include "policy/onnx_policy.hpp"

namespace pmg::test {

inline std::filesystem::path trained_policy_file() {
  return pmg::test::project_folder() + "/config/robots/z1/policies/pmg.onnx";
}

inline std::unique_ptr<policy::OnnxPolicy> trained_policy(const model::RobotModel& robot) {
  const std::filesystem::path file = trained_policy_file();
  const Ort::Env environment;
  const Ort::Session session(environment, file.c_str(), Ort::SessionOptions());
  const Ort::AllocatorWithDefaultOptions allocator;
  const auto text = session.GetModelMetadata().LookupCustomMetadataMapAllocated("pmg_policy", allocator);
  const auto clips = nlohmann::json::parse(text.get()).at("clip_library_sha256").get<std::string>();
  return std::make_unique<policy::OnnxPolicy>(file, robot, clips);
}

}  // namespace pmg::test
