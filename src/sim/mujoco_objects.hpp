// MuJoCo's model and data, deleted with their owner.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>

namespace pmg::sim {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, DeleteModel>;
using DataPointer = std::unique_ptr<mjData, DeleteData>;

}  // namespace pmg::sim
