#include "sim/scene.hpp"

#include <algorithm>
#include <iterator>

namespace pmg::sim {

Scene::Scene(const mjModel* model) : model_(model) {
  constexpr int kMaxGeoms = 2000;
  mjv_defaultOption(&visible_);
  std::fill(std::begin(visible_.geomgroup), std::end(visible_.geomgroup), mjtByte{0});
  visible_.geomgroup[0] = visible_.geomgroup[1] = 1;  // the floor and the visual shapes
  std::fill(std::begin(visible_.sitegroup), std::end(visible_.sitegroup), mjtByte{0});
  mjv_defaultScene(&scene_);
  mjv_makeScene(model, &scene_, kMaxGeoms);
  scene_.flags[mjRND_FOG] = 1;
}

Scene::~Scene() { mjv_freeScene(&scene_); }

mjvScene& Scene::update(mjData* data, mjvCamera& camera, const std::optional<Rope>& rope, std::span<const Bar> bars) {
  mjv_updateScene(model_, data, &visible_, nullptr, &camera, mjCAT_ALL, &scene_);
  if (rope) add({rope->bottom_W, rope->top_W, 0.006, {0.12F, 0.13F, 0.15F, 1.0F}});
  for (const Bar& bar : bars) add(bar);
  return scene_;
}

void Scene::add(const Bar& bar) {
  if (scene_.ngeom >= scene_.maxgeom) return;
  mjvGeom& geom = scene_.geoms[scene_.ngeom++];
  mjv_initGeom(&geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, bar.colour.data());
  const Eigen::Vector3d &a = bar.from_W, &b = bar.to_W;
  mjv_makeConnector(&geom, mjGEOM_CAPSULE, bar.radius_m, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

}  // namespace pmg::sim
