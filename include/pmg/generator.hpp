// The parameterized motion generator (paper III-A.2) as one class: command in, reference out, once per tick.
// Longer than 300 lines: its stages share the state of one walk, and the header stands alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "pmg/admissible_set.hpp"
#include "pmg/blending.hpp"
#include "pmg/clip.hpp"
#include "pmg/clip_sampling.hpp"
#include "pmg/command.hpp"
#include "pmg/command_limiter.hpp"
#include "pmg/contact.hpp"
#include "pmg/corner_clips.hpp"
#include "pmg/half_gain.hpp"
#include "pmg/joint_clamp.hpp"
#include "pmg/library_check.hpp"
#include "pmg/mirror.hpp"
#include "pmg/phase.hpp"
#include "pmg/posture.hpp"
#include "pmg/reference.hpp"

namespace pmg {

/// The duty factor r between standing (r = 1) and walking (r_d, the clips' average, paper eq. 8).
enum class StanceRule {
  /// r = r_d as soon as any gain is positive, r = 1 at rest; between the two it ramps over stance_ramp_s. The default,
  /// because a small gain lifts the feet in the clips' own swing windows, only less high: a longer stance would declare
  /// a moving foot loaded.
  kRestRamp,
  /// r = sum g_i r_i + (1 - sum g_i): standing counts with its share of the motion.
  kGainWeighted,
};

struct GeneratorOptions {
  std::optional<Blend> blend;  ///< the library's if not given
  CommandLimits limits;
  /// u_max_i for positive and for negative commands, positive numbers; the library's own go before them.
  std::array<double, kVelocityChannels> scale_positive{}, scale_negative{};
  double limit_margin_rad = 0.0349066;  ///< 2 degrees
  double contact_edge_cycle = 0.04;     ///< width of the contact weights' cosine edges, inside the stance
  double rest_before_freeze_s = 0.5;
  StanceRule stance_rule = StanceRule::kRestRamp;
  double stance_ramp_s = 0.2;
  double double_support_rate = 0.15;  ///< share of the velocity channels' rates in double support, in (0, 1]
  /// From the command of zero velocity to zero gains, in any phase: 0.5 s from the release of a key to rest, minus
  /// 0.05 s until the release arrives.
  double stop_within_s = 0.45;
  /// A channel that turns gets its rate in the other direction back within this time (CommandLimiter): shorter than a
  /// driver notices, and a command that flickers every tick of 0.01 s changes its rate by a tenth of the limit.
  double turn_s = 0.1;
};

/// q_ref(phi) = q_d + q_s (paper eq. 10) with q_d = sum g_i q_i(phi) + (1 - sum g_i) q_stand, and the bends of clips
/// that say how they look at half gain (half_gain.hpp).
///
/// The stages of a tick:
///   (user, dt) => (wanted)              CommandLimiter: range and rate limits; set_correction() is added
///   (wanted) => (asked)                 CommandInverse: the command to ask of the clips
///   (asked) => (q_s, gains)             posture, then velocities, are scaled into the AdmissibleSet
///   (weights, dt) => (phi, contacts)    phi advances by dt / T; contacts follow from mu and r
///   (phi, gains, q_s) => (q_ref, dq_ref)
/// A velocity direction without a clip (vx < 0 without a backward clip) and a posture channel without rows have the
/// range 0.
class Generator {
 public:
  /// Allocates. Throws std::invalid_argument, saying what was expected, for: joint counts that differ, fewer than 8
  /// samples, values that aren't finite, period <= 0, duty factor outside (0, 1], contact centres of one foot more than
  /// 0.15 cycles apart, posture ranges without 0, q_stand closer to a joint limit than the margin, options out of
  /// range.
  Generator(const ClipLibrary& library, const GeneratorOptions& options) : options_(options) {
    check_options();
    check::stand_and_limits(library, options_.limit_margin_rad);
    inverse_ = library.inverse;
    blend_ = options_.blend.value_or(library.blend);
    q_stand_ = library.q_stand;
    q_lower_ = library.q_lower;
    q_upper_ = library.q_upper;
    const auto directions = all_directions(library);
    PerCorner<std::optional<DynamicClip>> clips;
    std::copy(directions.begin(), directions.end(), clips.begin());
    check::contact_centers(clips);
    if (blend_ == Blend::kCorners) add_corner_clips(library, clips);
    timings_ = GaitTimings(clips);
    admissible_ = AdmissibleSet(q_stand_, q_lower_, q_upper_, options_.limit_margin_rad);
    const bool bends = std::any_of(directions.begin(), directions.end(),
                                   [](const auto& clip) { return clip && has_half_gain(*clip); });
    for (std::size_t c = 0; c < kCorners; ++c) {
      if (!clips[c]) continue;
      curve_[c] = ClipCurve(*clips[c]);
      admissible_.add(c, curve_[c], q_stand_);
      if (c >= kDirections || !bends) continue;
      admissible_.add_phases(c, *clips[c], q_stand_);
      if (has_half_gain(*clips[c])) bend_[c] = ClipCurve(bend_of(*clips[c], q_stand_));
    }
    for (std::size_t i = 0; i < kPostureChannels; ++i) {
      check::static_clip(library.posture[i], q_stand_, std::string("clip ") + kChannelNames[kVelocityChannels + i]);
    }
    posture_ = Posture(library.posture, q_stand_);
    limits_ = realisable_limits(directions, library.velocity_scale);
    limiter_ = CommandLimiter(limits_, options_.double_support_rate, options_.stop_within_s, options_.turn_s);
    reset();
  }

  /// Goes to rest: q_stand, phase frozen in the middle of a double support.
  void reset() noexcept {
    limiter_.reset();
    stance_.reset();
    timing_ = timings_.first();
    phase_.reset(double_support_phase(timing_));
    gain_.fill(0.0);
    velocity_share_ = 1.0;
    correction_ = {};
    q_s_.setZero(q_stand_.size());
    previous_q_s_ = q_s_;
    reference_ = Reference{};
    reference_.q = q_stand_;
    reference_.dq.setZero(q_stand_.size());
    set_contacts(0.0);
  }

  /// Another rate limit for this channel [1/s], until reset().
  void set_rate(Channel channel, double rate_per_s) noexcept { limiter_.set_rate(channel, rate_per_s); }

  /// From now on until reset(), what to add to the velocities of the user's admissible command [m/s, m/s, rad/s],
  /// within their range. reference().command has it, and reference().correction says how much; command_limited judges
  /// the user's command alone.
  void set_correction(const std::array<double, kVelocityChannels>& correction) noexcept { correction_ = correction; }

  /// One tick: (user, dt) => (reference). No heap, no exception. A channel that isn't finite keeps its last value. A dt
  /// that isn't positive changes nothing.
  const Reference& step(const Command& user, double dt_s) noexcept {
    if (!(dt_s > 0.0 && std::isfinite(dt_s))) return reference_;
    const Command& admitted =
        limiter_.step(user, reference_.contact_weight[kLeft] * reference_.contact_weight[kRight], dt_s);
    const Command wanted = corrected(admitted);
    const Command asked = apply_inverse(wanted);
    const double posture_share = posture_scale(
        admissible_, [&](double scale, JointVector& q_s) { posture_.offset(asked, scale, q_s); }, q_s_);
    Mixture mixture = mix(blend_, asked, scale_);
    const double velocity_share = follow(admissible_.velocity_scale(mixture.gain, q_s_, mixture.size), dt_s);
    for (std::size_t c = 0; c < mixture.size; ++c) mixture.gain[c] *= velocity_share;
    mixture.gain_sum *= velocity_share;

    report_command(wanted, asked, mixture, posture_share, dt_s);
    // A limit counts only if the user's command exceeds it without any correction.
    const bool too_much = mixture.normalised && mix(blend_, admitted, scale_).normalised;
    reference_.command_limited = limiter_.limited() || too_much || posture_share < 1.0 || velocity_share < 1.0;
    advance_gait(mixture, dt_s);
    blend(mixture, dt_s);
    reference_.joint_clamped = clamp_joints(q_lower_, q_upper_, reference_.q, reference_.dq);
    return reference_;
  }

  const Reference& reference() const noexcept { return reference_; }

  /// The library with a clip at every corner that its rule uses, so constructors of many generators do that work only
  /// once. Allocates; throws as the constructor does.
  static ClipLibrary completed(ClipLibrary library) {
    if (library.blend != Blend::kCorners) return library;
    const auto directions = all_directions(library);
    PerCorner<std::optional<DynamicClip>> clips;
    std::copy(directions.begin(), directions.end(), clips.begin());
    add_corner_clips(library, clips);
    library.corners.clear();
    for (std::size_t c = kDirections; c < kCorners; ++c) {
      if (clips[c]) library.corners.push_back({kCornerTable[c].sign, *clips[c]});
    }
    return library;
  }

 private:
  void check_options() {
    check::command_limits(options_.limits);
    check::require(std::isfinite(options_.limit_margin_rad), "limit_margin_rad; expected a number");
    check::require(options_.contact_edge_cycle > 0.0 && options_.contact_edge_cycle < 0.5,
                   "contact_edge_cycle; expected in (0, 0.5)");
    check::require(options_.rest_before_freeze_s >= 0.0, "rest_before_freeze_s; expected 0 or more");
    check::require(options_.stance_ramp_s >= 0.0, "stance_ramp_s; expected 0 or more");
    check::require(options_.double_support_rate > 0.0 && options_.double_support_rate <= 1.0,
                   "double_support_rate; expected in (0, 1], or no robot at rest would ever start");
    check::require(options_.stop_within_s > 0.0, "stop_within_s; expected more than 0");
    check::require(options_.turn_s >= 0.0 && options_.turn_s < options_.stop_within_s,
                   "turn_s; expected 0 or more and less than stop_within_s");
  }

  /// The library's clips, checked; a missing side of vy or omega is mirrored from the other.
  static PerDirection<std::optional<DynamicClip>> all_directions(const ClipLibrary& library) {
    PerDirection<std::optional<DynamicClip>> clips;
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      clips[direction_of(channel, false)] = library.positive[channel];
      clips[direction_of(channel, true)] = library.negative[channel];
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      if (clips[d]) check::dynamic_clip(*clips[d], library.q_stand.size(), check::corner_name(d));
    }
    for (const std::size_t channel : {std::size_t{kVy}, std::size_t{kOmega}}) {
      auto& positive = clips[direction_of(channel, false)];
      auto& negative = clips[direction_of(channel, true)];
      if (positive.has_value() == negative.has_value()) continue;
      check::mirror_map(library.mirror, library.q_stand.size());
      (positive ? negative : positive) = mirrored(library.mirror, positive ? *positive : *negative);
    }
    return clips;
  }

  /// The options' limits, narrowed to the directions and postures that have clips. Also sets scale_.
  CommandLimits realisable_limits(const PerDirection<std::optional<DynamicClip>>& clips,
                                  const std::optional<VelocityScale>& of_library) {
    CommandLimits limits = options_.limits;
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      const std::size_t forward = direction_of(channel, false), back = direction_of(channel, true);
      scale_[forward] = of_library ? of_library->positive[channel] : options_.scale_positive[channel];
      scale_[back] = of_library ? of_library->negative[channel] : options_.scale_negative[channel];
      if (!clips[forward]) limits.upper[channel] = 0.0;
      if (!clips[back]) limits.lower[channel] = 0.0;
      check::require((limits.upper[channel] == 0.0 || scale_[forward] > 0.0) &&
                         (limits.lower[channel] == 0.0 || scale_[back] > 0.0),
                     std::string("scale of ") + kChannelNames[channel] + "; expected more than 0");
    }
    for (std::size_t i = 0; i < kPostureChannels; ++i) {
      const std::size_t channel = kVelocityChannels + i;
      limits.lower[channel] = std::max(limits.lower[channel], posture_.curve(i).lower());
      limits.upper[channel] = std::min(limits.upper[channel], posture_.curve(i).upper());
    }
    return limits;
  }

  /// The phase that maximises the smaller of both feet's r / 2 - |wrap(phi - mu)|: the middle of a double support.
  static double double_support_phase(const GaitTiming& timing) noexcept {
    double best_phase = 0.0, best_margin = -1.0;
    for (int k = 0; k < 200; ++k) {
      const double phase = k / 200.0;
      double margin = 1.0;
      for (const Foot foot : {kLeft, kRight}) {
        const double distance = std::abs(wrap_half_cycle(phase - timing.contact_center[foot]));
        margin = std::min(margin, 0.5 * timing.duty_factor[foot] - distance);
      }
      if (margin > best_margin + 1e-12) {  // of two equal double supports the first, whatever the rounding
        best_margin = margin;
        best_phase = phase;
      }
    }
    return best_phase;
  }

  /// (the user's admissible command) => (wanted, Reference::correction).
  Command corrected(Command command) noexcept {
    for (std::size_t c = 0; c < kVelocityChannels; ++c) {
      const double admitted = command.u[c];
      if (correction_[c] != 0.0)
        command.u[c] = std::clamp(admitted + correction_[c], limits_.lower[c], limits_.upper[c]);
      reference_.correction[c] = command.u[c] - admitted;
    }
    return command;
  }

  /// (wanted) => (asked): the inverse's result, clamped to limits_ in the channels that it changed.
  Command apply_inverse(const Command& wanted) const noexcept {
    Command asked = inverse_.apply(wanted);
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      if (asked.u[channel] == wanted.u[channel]) continue;
      asked.u[channel] = std::clamp(asked.u[channel], limits_.lower[channel], limits_.upper[channel]);
    }
    return asked;
  }

  /// (admissible share of the gains) => (share that is played). Where the set's share may jump, the share takes its
  /// time; what joints lack of room meanwhile, clamp_joints takes.
  double follow(double velocity_share, double dt_s) noexcept {
    const double most = kShareRate_per_s * dt_s;
    velocity_share_ = admissible_.bends() ? velocity_share_ + std::clamp(velocity_share - velocity_share_, -most, most)
                                          : velocity_share;
    return velocity_share_;
  }

  /// (gains, posture share) => (Reference::command): the command that the clips realise, less the inverse's correction
  /// asked - wanted.
  void report_command(const Command& wanted, const Command& asked, const Mixture& mixture, double posture_share,
                      double dt_s) noexcept {
    const auto report = [&](std::size_t channel, double value) {
      reference_.command_rate.u[channel] = (value - reference_.command.u[channel]) / dt_s;
      reference_.command.u[channel] = value;
    };
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      const std::size_t forward = direction_of(channel, false), back = direction_of(channel, true);
      double given = mixture.gain[forward] * scale_[forward] - mixture.gain[back] * scale_[back];
      for (std::size_t c = kDirections; c < mixture.size; ++c) {
        const int sign = kCornerTable[c].sign[channel];
        if (sign != 0) given += sign * mixture.gain[c] * scale_[sign < 0 ? back : forward];
      }
      report(channel, given - (asked.u[channel] - wanted.u[channel]));
    }
    for (std::size_t channel = kVelocityChannels; channel < kChannels; ++channel) {
      report(channel, posture_share * asked.u[channel] - (asked.u[channel] - wanted.u[channel]));
    }
  }

  /// (weights, dt) => (T, mu, r, phi, contacts).
  void advance_gait(const Mixture& mixture, double dt_s) noexcept {
    const bool at_rest = mixture.gain_sum == 0.0;
    if (!at_rest) timing_ = timings_.average(mixture.weight, mixture.size);
    stance_.step(at_rest, options_.stance_ramp_s, dt_s);
    phase_.advance(timing_.period_s, at_rest, dt_s);
    set_contacts(mixture.gain_sum);
    phase_.freeze_after_rest(options_.rest_before_freeze_s, reference_.contact[kLeft] && reference_.contact[kRight]);
  }

  void set_contacts(double gain_sum) noexcept {
    const double standing = options_.stance_rule == StanceRule::kRestRamp ? stance_.standing() : 1.0 - gain_sum;
    reference_.phase = phase_.phase();
    reference_.phase_rate_per_s = phase_.rate_per_s();
    reference_.gain = gain_sum;
    reference_.contact_center = timing_.contact_center;
    for (const Foot foot : {kLeft, kRight}) {
      const double mu = timing_.contact_center[foot];
      const double r = timing_.duty_factor[foot] + standing * (1.0 - timing_.duty_factor[foot]);
      reference_.duty_factor[foot] = r;
      reference_.contact[foot] = in_contact(phase_.phase(), mu, r);
      reference_.contact_weight[foot] = contact_weight(phase_.phase(), mu, r, options_.contact_edge_cycle);
    }
  }

  /// (phi, dphi/dt, gains, q_s) => (q_ref, dq_ref). Rates of gains and offsets are backward differences, so dq_ref is
  /// the derivative of the q_ref that is put out.
  void blend(const Mixture& mixture, double dt_s) noexcept {
    PerCorner<double> gain_rate_per_s;
    double gain_sum_rate_per_s = 0.0;
    for (std::size_t d = 0; d < mixture.size; ++d) {
      gain_rate_per_s[d] = (mixture.gain[d] - gain_[d]) / dt_s;
      gain_sum_rate_per_s += gain_rate_per_s[d];
    }
    reference_.q.noalias() = (1.0 - mixture.gain_sum) * q_stand_ + q_s_;
    reference_.dq.noalias() = (q_s_ - previous_q_s_) * (1.0 / dt_s) - gain_sum_rate_per_s * q_stand_;
    ClipCurve::Segment segment;
    double samples = 0.0;  // for which the segment holds: most libraries' clips have equally many
    for (std::size_t d = 0; d < mixture.size; ++d) {
      if (mixture.gain[d] == 0.0 && gain_rate_per_s[d] == 0.0) continue;
      if (curve_[d].samples() != samples) {
        segment = curve_[d].segment(phase_.phase());
        samples = curve_[d].samples();
      }
      curve_[d].add_blended(segment, phase_.rate_per_s(), mixture.gain[d], gain_rate_per_s[d], reference_.q,
                            reference_.dq);
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      if (bend_[d].samples() == 0.0) continue;
      const double bend = bend_gain(mixture.gain[d]);
      const double bend_rate_per_s = (bend - bend_gain(gain_[d])) / dt_s;
      if (bend == 0.0 && bend_rate_per_s == 0.0) continue;
      if (bend_[d].samples() != samples) {
        segment = bend_[d].segment(phase_.phase());
        samples = bend_[d].samples();
      }
      bend_[d].add_blended(segment, phase_.rate_per_s(), bend, bend_rate_per_s, reference_.q, reference_.dq);
    }
    std::copy_n(mixture.gain.begin(), mixture.size, gain_.begin());
    previous_q_s_ = q_s_;
  }

  static constexpr double kShareRate_per_s = 2.0;  ///< twice as fast as robot.yaml lets Z1's gains move

  GeneratorOptions options_;
  CommandLimits limits_;  ///< the options' limits, narrowed by realisable_limits()
  CommandInverse inverse_;
  std::array<double, kVelocityChannels> correction_{};
  Blend blend_ = Blend::kGain;
  JointVector q_stand_, q_lower_, q_upper_;  ///< [rad]
  PerCorner<ClipCurve> curve_;               ///< empty where there is no clip
  PerDirection<ClipCurve> bend_;             ///< b of half_gain.hpp; empty where a clip has none
  PerDirection<double> scale_{};             ///< u_max of each direction
  GaitTimings timings_;
  Posture posture_;
  AdmissibleSet admissible_;

  CommandLimiter limiter_;
  GaitPhase phase_;
  StanceRamp stance_;
  GaitTiming timing_;         ///< of the last motion; held at rest
  PerCorner<double> gain_{};  ///< of the previous tick
  double velocity_share_ = 1.0;
  JointVector q_s_, previous_q_s_;
  Reference reference_;
};

}  // namespace pmg
