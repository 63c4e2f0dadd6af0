#include "sim/renderer.hpp"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/scene.hpp"

namespace pmg::sim {

namespace {

/// OSMesa, loaded by the first renderer: MuJoCo uses the first OpenGL library that it finds in the process, and a
/// window (viewer.hpp) needs another one. OSMesa stays loaded, because MuJoCo keeps pointers into it.
struct OsMesa {
  decltype(&OSMesaCreateContextExt) create;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaDestroyContext) destroy;

  static const OsMesa& get() {
    static const OsMesa library = load();
    return library;
  }

 private:
  static OsMesa load() {
    void* library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) library = dlopen("libOSMesa.so", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(std::string("OSMesa can't be loaded: ") + dlerror());
    const auto find = [library]<typename Function>(Function*& function, const char* name) {
      function = reinterpret_cast<Function*>(dlsym(library, name));
      if (function == nullptr) throw std::runtime_error(std::string("OSMesa lacks ") + name);
    };
    OsMesa functions{};
    find(functions.create, "OSMesaCreateContextExt");
    find(functions.make_current, "OSMesaMakeCurrent");
    find(functions.destroy, "OSMesaDestroyContext");
    return functions;
  }
};

/// MuJoCo draws into its own buffer with antialiasing; the context's buffer only has to exist.
class GlContext {
 public:
  GlContext() : context_(OsMesa::get().create(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr ||
        OsMesa::get().make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_FALSE) {
      OsMesa::get().destroy(context_);
      throw std::runtime_error("OSMesa gives no OpenGL context");
    }
  }
  // NOLINTNEXTLINE(bugprone-exception-escape): get() throws at its first call only
  ~GlContext() { OsMesa::get().destroy(context_); }
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
        scene(model),
        viewport{0, 0, options.width, options.height},
        rows(3 * pixels()),
        rgb(3 * pixels()) {
    if (options.mounted) {
      body = mj_name2id(model, mjOBJ_BODY, options.mounted->body.c_str());
      if (body < 0) throw std::runtime_error("no body " + options.mounted->body + " for the camera");
    }
    mjr_defaultContext(&context);
    mjr_makeContext(model, &context, mjFONTSCALE_150);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FREE;
    camera.distance = options.distance_m;
    camera.azimuth = options.azimuth_deg;
    camera.elevation = options.elevation_deg;
  }
  ~Impl() { mjr_freeContext(&context); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t pixels() const {
    return static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  }

  void follow(const mjData* data) {
    Eigen::Vector3d target = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * Scene::kBaseBody);
    const double elapsed_s = data->time - last_time_s.value_or(data->time);
    const bool first = !last_time_s || elapsed_s < 0.0;
    const double share = first ? 1.0 : 1.0 - std::exp(-elapsed_s / options.follow_s);
    Eigen::Map<Eigen::Vector3d> look(camera.lookat);
    look += share * (target - look);
    camera.azimuth += share * std::remainder(azimuth_deg - camera.azimuth, 360.0);
    last_time_s = data->time;
  }

  /// Both eyes of the scene look from the camera's body.
  void mount(const mjData* data, mjvScene& drawn) const {
    constexpr double kNear_m = 0.05, kFar_m = 50.0;
    const MountedCamera& mounted = *options.mounted;
    Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
    T_WB.translation() = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * body);
    T_WB.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * body);
    const Eigen::Isometry3f T_WC = (T_WB * mounted.T_BC).cast<float>();
    const auto top = static_cast<float>(kNear_m * std::tan(mounted.half_height_rad));
    for (mjvGLCamera& eye : drawn.camera) {
      Eigen::Map<Eigen::Vector3f>(eye.pos) = T_WC.translation();
      Eigen::Map<Eigen::Vector3f>(eye.forward) = T_WC.linear() * Eigen::Vector3f::UnitX();
      Eigen::Map<Eigen::Vector3f>(eye.up) = T_WC.linear() * Eigen::Vector3f::UnitZ();
      eye.frustum_center = 0.0F;
      eye.frustum_bottom = -top;
      eye.frustum_top = top;
      eye.frustum_near = static_cast<float>(kNear_m);
      eye.frustum_far = static_cast<float>(kFar_m);
    }
  }

  RendererOptions options;
  const mjModel* model;
  int body = -1;  // of a mounted camera
  GlContext gl;   // before the members that live in it
  Scene scene;
  mjvCamera camera{};
  mjrContext context{};
  mjrRect viewport;
  std::vector<std::uint8_t> rows, rgb;  // from the bottom up, from the top down
  std::optional<double> last_time_s;
  double azimuth_deg = options.azimuth_deg;  // where the camera is turning to
};

Renderer::Renderer(const mjModel* model, const RendererOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}

Renderer::~Renderer() = default;

const std::vector<std::uint8_t>& Renderer::render(mjData* data, const std::string& text,
                                                  const std::optional<Rope>& rope, std::span<const Bar> bars) {
  Impl& r = *impl_;
  r.follow(data);
  mjvScene& drawn = r.scene.update(data, r.camera, rope, bars);
  if (r.options.mounted) r.mount(data, drawn);
  mjr_render(r.viewport, &drawn, &r.context);
  if (!text.empty()) mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, r.viewport, text.c_str(), nullptr, &r.context);
  mjr_readPixels(r.rows.data(), nullptr, r.viewport, &r.context);
  const std::size_t row = 3 * static_cast<std::size_t>(r.options.width);
  for (std::size_t y = 0; y < r.rows.size(); y += row)
    std::copy_n(r.rows.begin() + static_cast<std::ptrdiff_t>(r.rows.size() - row - y), row,
                r.rgb.begin() + static_cast<std::ptrdiff_t>(y));
  return r.rgb;
}

void Renderer::look_from(double azimuth_deg) { impl_->azimuth_deg = azimuth_deg; }

int Renderer::width() const { return impl_->options.width; }
int Renderer::height() const { return impl_->options.height; }

}  // namespace pmg::sim
