#include "sim/box_contacts.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <mutex>

namespace pmg::sim {

namespace {

constexpr double kDeepest_m = 0.02;

mjfCollision mujocos = nullptr;  // set once, before any simulation

int without_phantoms(const mjModel* model, const mjData* data, mjContact* contacts, int one, int other, mjtNum margin) {
  const int count = mujocos(model, data, contacts, one, other, margin);
  const auto deep = [](const mjContact& contact) { return contact.dist < -kDeepest_m; };
  return static_cast<int>(std::remove_if(contacts, contacts + count, deep) - contacts);
}

}  // namespace

void drop_phantom_contacts() {
  static std::once_flag done;
  std::call_once(done, [] {
    mujocos = mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_BOX];
    mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_BOX] = without_phantoms;
  });
}

}  // namespace pmg::sim
