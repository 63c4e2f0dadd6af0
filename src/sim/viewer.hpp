// A window with a robot: MuJoCo's renderer on GLFW. Left button turns, right button shifts, wheel zooms. Esc and q
// close it, unless ViewerOptions::on_key takes the keys.
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

/// One event of a key; events come in their order.
struct ViewerKey {
  enum class What {
    kPressed,
    kRepeats,  ///< held down, and repeated automatically
    kReleased,
    kUnheard,  ///< the window lost the keyboard: the release of held keys won't be reported
  };
  What what = What::kPressed;
  /// The key's label on its keyboard: "w"; or "up", "down", "left", "right", "escape", "enter", "space", "backspace".
  /// Empty for other keys and for kUnheard.
  std::string name;
  bool shift = false;
};

/// Text beside the picture.
struct ViewerPanel {
  std::string labels, values;                ///< two columns, top left; the same number of lines in both
  std::string bottom_labels, bottom_values;  ///< the same, bottom left
};

struct ViewerOptions {
  int width = 1280, height = 800;  ///< of the window, in screen coordinates; less where the screen has less room
  std::string title = "PMG";
  std::function<void(const ViewerKey&)> on_key{};  ///< called from show() or poll(); then Esc and q don't close
};

/// Belongs to the main thread, as window systems require. It draws from a copy of the positions, so the simulation may
/// run in another thread; model is only read. One process can't have a Viewer and a Renderer: MuJoCo uses one OpenGL.
struct WindowSize {
  int width = 0, height = 0;
};

/// (wanted size, the screen's room beside panels) => the size, with its frame and title within the room.
WindowSize fitted(WindowSize wanted, WindowSize room);

class Viewer {
 public:
  /// Throws std::runtime_error, in one line, if no window can be opened (no display, no OpenGL).
  explicit Viewer(const mjModel* model, const ViewerOptions& options = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Draws one frame: the robot at qpos (the model's nq values), text over the top left corner. Handles mouse and keys.
  /// Waits for the screen's refresh if the driver does. Does nothing once closed.
  void show(std::span<const double> qpos, const std::string& text = "", const std::optional<Rope>& rope = std::nullopt);

  /// The two halves of show(), for a window whose keys must not wait for its pictures. After release() exactly one
  /// other thread draws and finally calls withdraw(); the main thread polls.
  void release();
  void poll();
  void draw(std::span<const double> qpos, const std::string& text, const std::optional<Rope>& rope,
            const ViewerPanel& panel);
  void withdraw();
  /// From behind the robot, turning with it; or back to the front left, where the window begins. Any thread.
  void look_from_the_other_side();

  bool closed() const;  ///< by its user

  /// The last frame without its text: RGB triples from the bottom left.
  std::vector<std::uint8_t> pixels();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::sim
