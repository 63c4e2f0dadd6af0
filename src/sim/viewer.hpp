// A window on a robot: MuJoCo's renderer on GLFW. Left button turns, right button shifts, wheel zooms; Esc or q closes,
// unless the keys are somebody else's.
#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/world.hpp"

namespace pmg::sim {

/// What happened to a key, in the order in which it did.
struct ViewerKey {
  enum class What {
    kPressed,
    kRepeats,  ///< it is held, and repeats by itself
    kReleased,
    kUnheard,  ///< the window lost the keyboard: whatever is held, its release won't be told
  };
  What what = What::kPressed;
  /// As its keyboard labels it: "w"; or "up", "down", "left", "right", "escape", "enter", "space", "backspace". Empty
  /// for others, and for kUnheard.
  std::string name;
  bool shift = false;
};

/// Text beside the picture.
struct ViewerPanel {
  std::string labels, values;                ///< two columns, top left; as many lines in both
  std::string bottom_labels, bottom_values;  ///< likewise, bottom left
};

struct ViewerOptions {
  int width = 1280, height = 800;  ///< of the window, in screen coordinates
  std::string title = "PMG";
  std::function<void(const ViewerKey&)> on_key{};  ///< called from show() or poll(); then Esc and q don't close
};

/// Belongs to the main thread, as the window system wants it. Draws from a copy of the positions, so the simulation may
/// go on in another thread; model is only read. Not together with a Renderer in one process: MuJoCo keeps one OpenGL.
class Viewer {
 public:
  /// Throws std::runtime_error, in one line, when no window can be opened (no display, no OpenGL).
  explicit Viewer(const mjModel* model, const ViewerOptions& options = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// One frame: the robot at qpos (the model's nq values), text over the top left corner. Handles mouse and keys; waits
  /// for the screen's refresh where the driver does. Does nothing once closed.
  void show(std::span<const double> qpos, const std::string& text = "", const std::optional<Rope>& rope = std::nullopt);

  /// show() in its two halves, for a window whose keys must not wait for its pictures. After release() one other thread
  /// draws, always the same, and ends with withdraw(); the main thread polls.
  void release();
  void poll();
  void draw(std::span<const double> qpos, const std::string& text, const std::optional<Rope>& rope,
            const ViewerPanel& panel);
  void withdraw();

  bool closed() const;  ///< by its user

  /// The last frame without its text: RGB triples from the bottom left.
  std::vector<std::uint8_t> pixels();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::sim
