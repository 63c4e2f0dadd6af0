#include "sim/renderer.hpp"

#include <GL/osmesa.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace pmg::sim {

namespace {

constexpr int kBaseBody = 1;  // body 0 is the world
constexpr int kMaxGeoms = 2000;

/// MuJoCo finds OSMesa by itself when it is linked and its context is current. It draws into a buffer of its own with
/// antialiasing; the context's buffer only has to exist.
class GlContext {
 public:
  GlContext() : context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr ||
        OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_FALSE) {
      OSMesaDestroyContext(context_);
      throw std::runtime_error("OSMesa gives no OpenGL context");
    }
  }
  ~GlContext() { OSMesaDestroyContext(context_); }
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

 private:
  static constexpr int kSide = 16;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(4 * kSide * kSide);
  OSMesaContext context_;
};

}  // namespace

struct Renderer::Impl {
  Impl(const mjModel* mj_model, const RendererOptions& renderer_options)
      : options(renderer_options),
        model(mj_model),
        viewport{0, 0, options.width, options.height},
        rows(3 * pixels()),
        rgb(3 * pixels()) {
    mjv_defaultOption(&visible);
    std::fill(std::begin(visible.geomgroup), std::end(visible.geomgroup), mjtByte{0});
    visible.geomgroup[0] = visible.geomgroup[1] = 1;  // the floor and the visual shapes
    std::fill(std::begin(visible.sitegroup), std::end(visible.sitegroup), mjtByte{0});
    mjv_defaultScene(&scene);
    mjv_makeScene(model, &scene, kMaxGeoms);
    mjr_defaultContext(&context);
    mjr_makeContext(model, &context, mjFONTSCALE_150);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    scene.flags[mjRND_FOG] = 1;
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FREE;
    camera.distance = options.distance_m;
    camera.azimuth = options.azimuth_deg;
    camera.elevation = options.elevation_deg;
  }
  ~Impl() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t pixels() const {
    return static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  }

  void follow(const mjData* data) {
    Eigen::Vector3d target = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * kBaseBody);
    const double elapsed_s = data->time - last_time_s.value_or(data->time);
    const bool first = !last_time_s || elapsed_s < 0.0;
    const double share = first ? 1.0 : 1.0 - std::exp(-elapsed_s / options.follow_s);
    Eigen::Map<Eigen::Vector3d> look(camera.lookat);
    look += share * (target - look);
    last_time_s = data->time;
  }

  void add(const Rope& rope) {
    if (scene.ngeom >= scene.maxgeom) return;
    constexpr double kRadius_m = 0.006;
    constexpr float kColour[4] = {0.12F, 0.13F, 0.15F, 1.0F};
    mjvGeom& geom = scene.geoms[scene.ngeom++];
    mjv_initGeom(&geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, kColour);
    const Eigen::Vector3d &a = rope.bottom_W, &b = rope.top_W;
    mjv_makeConnector(&geom, mjGEOM_CAPSULE, kRadius_m, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }

  RendererOptions options;
  const mjModel* model;
  GlContext gl;  // before everything that lives in it
  mjvOption visible{};
  mjvScene scene{};
  mjvCamera camera{};
  mjrContext context{};
  mjrRect viewport;
  std::vector<std::uint8_t> rows, rgb;  // from the bottom up, from the top down
  std::optional<double> last_time_s;
};

Renderer::Renderer(const mjModel* model, const RendererOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}

Renderer::~Renderer() = default;

const std::vector<std::uint8_t>& Renderer::render(mjData* data, const std::string& text,
                                                  const std::optional<Rope>& rope) {
  Impl& r = *impl_;
  r.follow(data);
  mjv_updateScene(r.model, data, &r.visible, nullptr, &r.camera, mjCAT_ALL, &r.scene);
  if (rope) r.add(*rope);
  mjr_render(r.viewport, &r.scene, &r.context);
  if (!text.empty()) mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, r.viewport, text.c_str(), nullptr, &r.context);
  mjr_readPixels(r.rows.data(), nullptr, r.viewport, &r.context);
  const std::size_t row = 3 * static_cast<std::size_t>(r.options.width);
  for (std::size_t y = 0; y < r.rows.size(); y += row)
    std::copy_n(r.rows.begin() + static_cast<std::ptrdiff_t>(r.rows.size() - row - y), row,
                r.rgb.begin() + static_cast<std::ptrdiff_t>(y));
  return r.rgb;
}

int Renderer::width() const { return impl_->options.width; }
int Renderer::height() const { return impl_->options.height; }

}  // namespace pmg::sim
