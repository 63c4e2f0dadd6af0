#include "sim/viewer.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "sim/mujoco_objects.hpp"
#include "sim/scene.hpp"

namespace pmg::sim {

namespace {

/// The window system's last error. Before version 3.4, GLFW reports errors only to a callback.
std::string& complaint() {
  static std::string text;
  return text;
}
void keep_complaint(int /*code*/, const char* description) { complaint() = description; }

[[noreturn]] void refuse() {
  throw std::runtime_error("no window can be opened: " + (complaint().empty() ? "no OpenGL" : complaint()) +
                           "; a viewer needs a desktop (without one: pmg_sil --video, pmg_keyboard)");
}

class Window {
 public:
  explicit Window(const ViewerOptions& options) {
    glfwSetErrorCallback(keep_complaint);
#ifdef GLFW_PLATFORM  // GLFW 3.4 tries Wayland first, whose library prints errors if there is none
    if (std::getenv("WAYLAND_DISPLAY") == nullptr) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (glfwInit() == GLFW_FALSE) refuse();
    glfwWindowHint(GLFW_SAMPLES, 4);
    WindowSize size{options.width, options.height};
    if (GLFWmonitor* screen = glfwGetPrimaryMonitor(); screen != nullptr) {
      int x = 0, y = 0;
      WindowSize room;
      glfwGetMonitorWorkarea(screen, &x, &y, &room.width, &room.height);
      size = fitted(size, room);
    }
    window_ = glfwCreateWindow(size.width, size.height, options.title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
      glfwTerminate();
      refuse();
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
  }
  ~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* get() const { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
};

/// ViewerKey::name.
std::string key_name(int key, int scancode) {
  switch (key) {
    case GLFW_KEY_UP:
      return "up";
    case GLFW_KEY_DOWN:
      return "down";
    case GLFW_KEY_LEFT:
      return "left";
    case GLFW_KEY_RIGHT:
      return "right";
    case GLFW_KEY_ESCAPE:
      return "escape";
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return "enter";
    case GLFW_KEY_SPACE:
      return "space";
    case GLFW_KEY_BACKSPACE:
      return "backspace";
    default:
      break;
  }
  const char* label = glfwGetKeyName(key, scancode);  // by the keyboard's layout
  return label == nullptr ? "" : label;
}

}  // namespace

WindowSize fitted(WindowSize wanted, WindowSize room) {
  constexpr int kFrame = 8, kTitle = 64;  // title bar, and a panel that a window system doesn't tell of
  if (room.width <= 0 || room.height <= 0) return wanted;
  return {std::min(wanted.width, std::max(room.width - kFrame, 1)),
          std::min(wanted.height, std::max(room.height - kTitle, 1))};
}

struct Viewer::Impl {
  static constexpr double kFrontLeft_deg = 216.0;  // from the robot's front and left, as in films

  Impl(const mjModel* mj_model, const ViewerOptions& options)
      : model(mj_model), on_key(options.on_key), window(options), data(mj_makeData(mj_model)), scene(mj_model) {
    mjr_defaultContext(&context);
    mjr_makeContext(model, &context, on_key ? mjFONTSCALE_100 : mjFONTSCALE_150);  // panels have more text
    mjr_setBuffer(mjFB_WINDOW, &context);
    mjv_defaultCamera(&camera);
    camera.distance = 3.2;
    camera.azimuth = kFrontLeft_deg;
    camera.elevation = -9.0;
    measure();
    glfwSetWindowUserPointer(window.get(), this);
    glfwSetKeyCallback(window.get(), take_key);
    glfwSetWindowFocusCallback(window.get(), take_focus);
    glfwSetScrollCallback(window.get(), on_scroll);
    glfwSetCursorPosCallback(window.get(), on_move);
  }
  ~Impl() {
    glfwMakeContextCurrent(window.get());
    mjr_freeContext(&context);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  static Impl& of(GLFWwindow* handle) { return *static_cast<Impl*>(glfwGetWindowUserPointer(handle)); }

  static void take_key(GLFWwindow* handle, int key, int scancode, int action, int modifiers) {
    if (const Impl& viewer = of(handle); viewer.on_key) {
      using What = ViewerKey::What;
      const What what = action == GLFW_PRESS    ? What::kPressed
                        : action == GLFW_REPEAT ? What::kRepeats
                                                : What::kReleased;
      const bool shift_key = key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT;
      const bool shift = (modifiers & GLFW_MOD_SHIFT) != 0;
      if (!shift_key) viewer.on_key({.what = what, .name = key_name(key, scancode), .shift = shift});
      return;
    }
    if (action == GLFW_PRESS && (key == GLFW_KEY_ESCAPE || key == GLFW_KEY_Q))
      glfwSetWindowShouldClose(handle, GLFW_TRUE);
  }
  static void take_focus(GLFWwindow* handle, int focused) {
    const Impl& viewer = of(handle);
    if (focused == GLFW_FALSE && viewer.on_key) viewer.on_key({.what = ViewerKey::What::kUnheard, .name = ""});
  }
  static void on_scroll(GLFWwindow* handle, double /*x*/, double y) {
    constexpr double kPerNotch = -0.05;
    of(handle).ask_for({mjMOUSE_ZOOM, 0.0, kPerNotch * y});
  }
  static void on_move(GLFWwindow* handle, double x, double y) {
    Impl& viewer = of(handle);
    int width = 0, height = 0;
    glfwGetWindowSize(handle, &width, &height);
    const double dx = (x - viewer.mouse_x) / std::max(height, 1), dy = (y - viewer.mouse_y) / std::max(height, 1);
    viewer.mouse_x = x;
    viewer.mouse_y = y;
    const auto pressed = [handle](int button) { return glfwGetMouseButton(handle, button) == GLFW_PRESS; };
    if (pressed(GLFW_MOUSE_BUTTON_LEFT)) {
      viewer.ask_for({mjMOUSE_ROTATE_V, dx, dy});
    } else if (pressed(GLFW_MOUSE_BUTTON_RIGHT)) {
      viewer.ask_for({mjMOUSE_MOVE_V, dx, dy});
    }
  }

  struct CameraMove {
    mjtMouse how;
    double dx, dy;
  };
  /// Queues the move for the thread that draws.
  void ask_for(const CameraMove& move) {
    const std::lock_guard lock(mutex);
    moves.push_back(move);
  }
  void move_camera() {
    const std::lock_guard lock(mutex);
    for (const CameraMove& move : moves) mjv_moveCamera(model, move.how, move.dx, move.dy, &scene.last(), &camera);
    moves.clear();
  }
  /// Reads the framebuffer's size, which only the main thread can.
  void measure() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window.get(), &width, &height);
    const std::lock_guard lock(mutex);
    framebuffer = {0, 0, width, height};
  }
  mjrRect measured() {
    const std::lock_guard lock(mutex);
    return framebuffer;
  }

  /// Moves with the robot; the user's shift stays. From behind it turns with the robot, too; the user's turn stays.
  void follow() {
    const mjtNum* base = data->xpos + 3 * Scene::kBaseBody;
    const mjtNum* R_WB = data->xmat + 9 * Scene::kBaseBody;
    const double yaw_deg = std::atan2(R_WB[3], R_WB[0]) * 180.0 / M_PI;
    const bool wanted = behind.load();
    if (wanted != shown_behind) camera.azimuth = wanted ? yaw_deg : kFrontLeft_deg;
    if (wanted && shown_behind) camera.azimuth += std::remainder(yaw_deg - followed_yaw_deg, 360.0);
    shown_behind = wanted;
    followed_yaw_deg = yaw_deg;
    for (int i = 0; i < 3; ++i) {
      camera.lookat[i] += first ? base[i] - camera.lookat[i] : base[i] - followed[i];
      followed[i] = base[i];
    }
    first = false;
  }

  const mjModel* model;
  std::function<void(const ViewerKey&)> on_key;
  Window window;  // before the members that live in its OpenGL context
  DataPointer data;
  Scene scene;
  mjrContext context{};
  mjvCamera camera{};
  double mouse_x = 0.0, mouse_y = 0.0;
  double followed[3] = {};
  bool first = true;
  std::atomic<bool> behind{false};
  bool shown_behind = false;
  double followed_yaw_deg = 0.0;
  mjrRect viewport{};
  std::mutex mutex;  // guards what the main thread passes to the drawing thread
  std::vector<CameraMove> moves;
  mjrRect framebuffer{};
};

Viewer::Viewer(const mjModel* model, const ViewerOptions& options) : impl_(std::make_unique<Impl>(model, options)) {}

Viewer::~Viewer() = default;

void Viewer::show(std::span<const double> qpos, const std::string& text, const std::optional<Rope>& rope) {
  if (closed()) return;
  draw(qpos, text, rope, {});
  poll();
}

void Viewer::release() { glfwMakeContextCurrent(nullptr); }

void Viewer::withdraw() { glfwMakeContextCurrent(nullptr); }

void Viewer::look_from_the_other_side() { impl_->behind.store(!impl_->behind.load()); }

void Viewer::poll() {
  glfwPollEvents();
  impl_->measure();
}

void Viewer::draw(std::span<const double> qpos, const std::string& text, const std::optional<Rope>& rope,
                  const ViewerPanel& panel) {
  Impl& v = *impl_;
  if (glfwGetCurrentContext() != v.window.get()) glfwMakeContextCurrent(v.window.get());
  std::copy_n(qpos.begin(), std::min(qpos.size(), static_cast<std::size_t>(v.model->nq)), v.data->qpos);
  mj_kinematics(v.model, v.data.get());
  mj_comPos(v.model, v.data.get());
  mj_camlight(v.model, v.data.get());
  v.move_camera();
  v.follow();
  v.viewport = v.measured();
  mjr_render(v.viewport, &v.scene.update(v.data.get(), v.camera, rope), &v.context);
  const auto overlay = [&v](int corner, const std::string& left, const std::string& right) {
    if (left.empty()) return;
    mjr_overlay(mjFONT_NORMAL, corner, v.viewport, left.c_str(), right.empty() ? nullptr : right.c_str(), &v.context);
  };
  overlay(mjGRID_TOPLEFT, text, "");
  overlay(mjGRID_TOPLEFT, panel.labels, panel.values);
  overlay(mjGRID_BOTTOMLEFT, panel.bottom_labels, panel.bottom_values);
  glfwSwapBuffers(v.window.get());
}

bool Viewer::closed() const { return glfwWindowShouldClose(impl_->window.get()) == GLFW_TRUE; }

std::vector<std::uint8_t> Viewer::pixels() {
  Impl& v = *impl_;
  std::vector<std::uint8_t> rgb(3 * static_cast<std::size_t>(v.viewport.width) *
                                static_cast<std::size_t>(v.viewport.height));
  mjr_render(v.viewport, &v.scene.last(), &v.context);  // the buffer that was shown has gone to the screen
  mjr_readPixels(rgb.data(), nullptr, v.viewport, &v.context);
  return rgb;
}

}  // namespace pmg::sim
