// The robot model and its world as MJCF text. MuJoCo 2.2.2 has no <frame>, no position kv and no actuatorfrcrange, and
// needs `limited` beside every range.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "files/config_error.hpp"
#include "pages/text.hpp"
#include "pmg/types.hpp"
#include "sim/mjcf_geometry.hpp"
#include "sim/world.hpp"

namespace pmg::sim {

namespace {

using pages::escape_markup;

// Contact classes: soles touch only the floor, bodies touch the floor and each other. Two geoms collide when one's
// contype meets the other's conaffinity: floor (1, 0), sole (0, 1), body (2, 3), foot body (2, 2); a foot body meets
// the floor through its sole. Props (1, 3) touch all of them; a fixed one (1, 0) is like the floor. Where a link has a
// hand box (2, 3), that touches props and the floor, and the link's own shapes (0, 2) only other links.
constexpr const char* kScene = R"(
  <compiler angle="radian" inertiafromgeom="false" balanceinertia="false"/>
  <option timestep="{timestep}" integrator="implicit" gravity="0 0 -{gravity}"/>
  <size njmax="600" nconmax="150"/>
  <statistic center="0 0 {look_height}" extent="{extent}"/>
  <visual>
    <global offwidth="1280" offheight="720" fovy="38"/>
    <quality shadowsize="1024" offsamples="0" numslices="14" numstacks="8"/>
    <headlight ambient="0.36 0.37 0.40" diffuse="0.22 0.22 0.23" specular="0.04 0.04 0.04"/>
    <map znear="0.02" zfar="40" fogstart="3" fogend="11" shadowclip="0.9"/>
    <rgba fog="0.76 0.83 0.90 1" haze="0.76 0.83 0.90 1"/>
  </visual>
  <default>
    <geom friction="{friction} 0.005 0.0001"/>
    <default class="visual"><geom group="1" contype="0" conaffinity="0" material="shell"/></default>
    <default class="collision"><geom group="3" contype="2" conaffinity="3" condim="1"/></default>
    <default class="foot_collision"><geom group="3" contype="2" conaffinity="2" condim="1"/></default>
    <default class="sole"><geom group="3" contype="0" conaffinity="1" condim="3"/></default>
  </default>
  <asset>
    <texture type="skybox" builtin="gradient" rgb1="0.36 0.52 0.72" rgb2="0.76 0.83 0.90" width="256" height="1536"/>
    <texture name="floor" type="2d" builtin="checker" mark="edge" rgb1="0.64 0.68 0.72" rgb2="0.58 0.62 0.665"
             markrgb="0.52 0.56 0.61" width="512" height="512"/>
    <material name="floor" texture="floor" texrepeat="1 1" texuniform="true" specular="0.1" shininess="0.2"/>
    <material name="shell" specular="0.35" shininess="0.45"/>
  </asset>
)";

constexpr const char* kFloor =
    R"(    <geom name="floor" type="plane" size="0 0 0.05" material="floor" contype="1" conaffinity="0" condim="3"/>)"
    "\n";

/// Directional, above and in front. It follows the robot, so the robot's shadow stays inside the shadow map.
constexpr const char* kLight =
    R"(<light mode="trackcom" directional="true" castshadow="true" pos="1.2 1.0 3.2" dir="-0.34 -0.28 -0.9" )"
    R"(diffuse="0.66 0.64 0.60" specular="0.30 0.30 0.30" ambient="0 0 0"/>)";

class MjcfText {
 public:
  MjcfText(const model::RobotModel& robot, const WorldOptions& options) : robot_(robot), options_(options) {}

  std::string build() {
    text_ = fmt::format("<mujoco model=\"{}\">", escape_markup(robot_.name));
    text_ +=
        fmt::format(kScene, fmt::arg("timestep", options_.timestep_s), fmt::arg("gravity", kGravity_m_s2),
                    fmt::arg("friction", options_.floor_friction), fmt::arg("look_height", robot_.standing_height_m),
                    fmt::arg("extent", 2.0 * robot_.standing_height_m));
    text_ += "  <worldbody>\n";
    text_ += kFloor;
    write_body(*robot_.urdf->getRoot(), nullptr, "", 2);
    for (const Prop& prop : options_.props) write_prop(prop);
    text_ += "  </worldbody>\n";
    write_exclusions();
    write_actuators();
    write_sensors();
    write_standing_keyframe();
    return text_ + "</mujoco>\n";
  }

 private:
  void line(int depth, const std::string& element) {
    text_.append(static_cast<std::size_t>(2 * depth), ' ');
    text_ += element;
    text_ += '\n';
  }

  /// colliding_ancestor: the nearest link above that has collision shapes; "" if there is none.
  void write_body(const urdf::Link& link, const urdf::Joint* joint, std::string colliding_ancestor, int depth) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (joint == nullptr) T.translation().z() = robot_.standing_height_m;
    if (joint != nullptr) T = isometry(joint->parent_to_joint_origin_transform);
    line(depth, fmt::format(R"(<body name="{}" {}>)", escape_markup(link.name), pose_attributes(T)));
    if (joint == nullptr) line(depth + 1, R"(<freejoint name="base"/>)");
    if (joint == nullptr) line(depth + 1, kLight);
    if (joint != nullptr && joint->type != urdf::Joint::FIXED) write_joint(joint->name, depth + 1);
    if (link.inertial) line(depth + 1, inertial_element(*link.inertial));
    write_visuals(link, depth + 1);
    write_collisions(link, depth + 1);
    for (const HandBox& box : options_.hand_boxes)
      if (box.link == link.name) write_hand_box(box, depth + 1);
    if (!link.collision_array.empty()) {
      if (!colliding_ancestor.empty()) neighbours_.emplace_back(colliding_ancestor, link.name);
      colliding_ancestor = link.name;
    }
    if (link.name == robot_.imu.link)
      line(depth + 1, fmt::format(R"(<site name="imu" group="4" size="0.01" {}/>)", pose_attributes(robot_.imu.T_LI)));
    for (const auto& child : children_in_joint_order(link))
      write_body(*child, child->parent_joint.get(), colliding_ancestor, depth + 1);
    line(depth, "</body>");
  }

  void write_prop(const Prop& prop) {
    const bool fixed = prop.mass_kg == 0.0;
    const Eigen::Vector3d &p = prop.p_WP_m, &h = prop.half_size_m;
    const auto& c = prop.colour;
    line(2, fmt::format(R"(<body name="{}" pos="{} {} {}" quat="{} 0 0 {}">)", escape_markup(prop.name), p.x(), p.y(),
                        p.z(), std::cos(0.5 * prop.yaw_rad), std::sin(0.5 * prop.yaw_rad)));
    if (!fixed) {
      line(3, "<freejoint/>");
      const Eigen::Vector3d squared = h.cwiseProduct(h) * prop.mass_kg / 3.0;
      line(3, fmt::format(R"(<inertial pos="0 0 0" mass="{}" diaginertia="{} {} {}"/>)", prop.mass_kg,
                          squared.y() + squared.z(), squared.x() + squared.z(), squared.x() + squared.y()));
    }
    line(3, fmt::format(R"(<geom group="1" type="box" size="{} {} {}" contype="1" conaffinity="{}" condim="4" )"
                        R"(friction="{} 0.005 0.0001" rgba="{} {} {} {}"/>)",
                        h.x(), h.y(), h.z(), fixed ? 0 : 3, prop.friction, c[0], c[1], c[2], c[3]));
    line(2, "</body>");
  }

  /// MuJoCo's friction creeps at v = (1 - d) / d A f tau / 2 under a force f below its limit (d: impedance, A: inverse
  /// inertia). With its defaults (d = 0.95, tau = 0.02 s) a box of 1 kg slides out of two hands at about 1 cm/s.
  void write_hand_box(const HandBox& box, int depth) {
    const Eigen::Vector3d& h = box.half_size_m;
    line(depth,
         fmt::format(R"(<geom class="collision" type="box" size="{} {} {}" condim="4" friction="{} 0.005 0.0001" )"
                     R"(priority="1" solref="0.01 1" solimp="0.99 0.999 0.001" {}/>)",
                     h.x(), h.y(), h.z(), box.friction, pose_attributes(box.T_LH)));
  }

  void write_joint(const std::string& name, int depth) {
    const model::Joint& joint = robot_.joints[static_cast<std::size_t>(robot_.joint_index.at(name))];
    line(depth,
         fmt::format(R"(<joint name="{}" type="hinge" axis="{} {} {}" limited="true" range="{} {}" armature="{}" )"
                     R"(damping="{}" frictionloss="{}"/>)",
                     escape_markup(name), joint.axis.x(), joint.axis.y(), joint.axis.z(), joint.lower_rad,
                     joint.upper_rad, joint.armature_kg_m2, joint.damping_Nm_s_per_rad, joint.friction_Nm));
  }

  void write_visuals(const urdf::Link& link, int depth) {
    for (const auto& visual : link.visual_array) {
      const auto shape = visual_shape(*visual->geometry);
      if (!shape) continue;
      std::string colour;
      if (visual->material) {
        const urdf::Color& c = visual->material->color;
        colour = fmt::format(R"( rgba="{} {} {} {}")", c.r, c.g, c.b, c.a);
      }
      line(depth,
           fmt::format(R"(<geom class="visual" {} {}{}/>)", *shape, pose_attributes(isometry(visual->origin)), colour));
    }
  }

  void write_collisions(const urdf::Link& link, int depth) {
    const model::FootModel* foot = nullptr;
    for (const auto& candidate : robot_.feet)
      if (candidate.link == link.name) foot = &candidate;
    const bool boxed =
        std::ranges::any_of(options_.hand_boxes, [&](const HandBox& box) { return box.link == link.name; });
    for (const auto& collision : link.collision_array) {
      const auto shape = collision_shape(*collision->geometry);
      if (!shape)
        throw files::ConfigError(fmt::format("{}: link {}: collision by a mesh; expected box, cylinder or sphere",
                                             (robot_.directory / "robot.yaml").string(), link.name));
      line(depth,
           fmt::format(R"(<geom class="{}" {} {}{}/>)", foot != nullptr ? "foot_collision" : "collision", *shape,
                       pose_attributes(isometry(collision->origin)), boxed ? R"( contype="0" conaffinity="2")" : ""));
    }
    if (foot == nullptr) return;
    const Eigen::Vector3d &c = foot->box_center_F, &h = foot->box_half_size_m;
    line(depth, fmt::format(R"(<geom name="{}_sole" class="sole" type="box" pos="{} {} {}" size="{} {} {}"/>)",
                            escape_markup(link.name), c.x(), c.y(), c.z(), h.x(), h.y(), h.z()));
  }

  /// Children sorted so that MuJoCo's depth-first order of coordinates is the robot's joint order, if the tree allows
  /// it.
  std::vector<urdf::LinkSharedPtr> children_in_joint_order(const urdf::Link& link) const {
    std::vector<urdf::LinkSharedPtr> children = link.child_links;
    std::stable_sort(children.begin(), children.end(),
                     [this](const auto& a, const auto& b) { return first_joint(*a) < first_joint(*b); });
    return children;
  }

  int first_joint(const urdf::Link& link) const {
    int first = robot_.joint_index.find(link.parent_joint->name).value_or(std::numeric_limits<int>::max());
    for (const auto& child : link.child_links) first = std::min(first, first_joint(*child));
    return first;
  }

  /// Neighbouring links overlap at their joint by design. MuJoCo excludes only direct parents, but the small links
  /// inside a compound joint have no shapes.
  void write_exclusions() {
    text_ += "  <contact>\n";
    for (const auto& [above, below] : neighbours_)
      line(2, fmt::format(R"(<exclude body1="{}" body2="{}"/>)", escape_markup(above), escape_markup(below)));
    text_ += "  </contact>\n";
  }

  void write_actuators() {
    text_ += "  <actuator>\n";
    for (const auto& joint : robot_.joints)
      line(2, fmt::format(R"(<general name="{0}" joint="{0}" gaintype="fixed" gainprm="{1}" biastype="affine" )"
                          R"(biasprm="0 {2} {3}" forcelimited="true" forcerange="{4} {5}"/>)",
                          escape_markup(joint.name), joint.kp_Nm_per_rad, -joint.kp_Nm_per_rad, -joint.kd_Nm_s_per_rad,
                          -joint.effort_limit_Nm, joint.effort_limit_Nm));
    text_ += "  </actuator>\n";
  }

  void write_sensors() {
    text_ += "  <sensor>\n";
    line(2, R"(<gyro name="imu_gyro" site="imu"/>)");
    line(2, R"(<accelerometer name="imu_accelerometer" site="imu"/>)");
    line(2, R"(<framequat name="imu_orientation" objtype="site" objname="imu"/>)");
    text_ += "  </sensor>\n";
  }

  void write_standing_keyframe() {
    std::string qpos = fmt::format("0 0 {} 1 0 0 0", robot_.standing_height_m);
    append_standing_angles(*robot_.urdf->getRoot(), qpos);
    for (const Prop& prop : options_.props) {
      if (prop.mass_kg == 0.0) continue;
      const Eigen::Vector3d& p = prop.p_WP_m;
      qpos += fmt::format(" {} {} {} {} 0 0 {}", p.x(), p.y(), p.z(), std::cos(0.5 * prop.yaw_rad),
                          std::sin(0.5 * prop.yaw_rad));
    }
    std::string ctrl;
    for (const auto& joint : robot_.joints) ctrl += fmt::format("{}{}", ctrl.empty() ? "" : " ", joint.stand_rad);
    text_ += "  <keyframe>\n";
    line(2, fmt::format(R"(<key name="stand" qpos="{}" ctrl="{}"/>)", qpos, ctrl));
    text_ += "  </keyframe>\n";
  }

  void append_standing_angles(const urdf::Link& link, std::string& qpos) const {
    for (const auto& child : children_in_joint_order(link)) {
      const auto joint = robot_.joint_index.find(child->parent_joint->name);
      if (joint) qpos += fmt::format(" {}", robot_.joints[static_cast<std::size_t>(*joint)].stand_rad);
      append_standing_angles(*child, qpos);
    }
  }

  const model::RobotModel& robot_;
  const WorldOptions& options_;
  std::string text_;
  std::vector<std::pair<std::string, std::string>> neighbours_;
};

}  // namespace

std::string mjcf(const model::RobotModel& robot, const WorldOptions& options) {
  return MjcfText(robot, options).build();
}

}  // namespace pmg::sim
