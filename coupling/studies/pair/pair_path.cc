#include "coupling/studies/pair/pair_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

}  // namespace

PairPath::PairPath(const PairSetup& s, const PairBodies& bodies)
    : start_(touching_pose(bodies, s.offset * s.radius)),
      radius_(s.radius),
      depth_(s.depth * s.radius),
      along_(s.amplitude * s.radius),
      across_(along_),
      swing_(s.swing * std::numbers::pi / 180),
      turns_(s.turns),
      at_wall_(bodies.has_wall),
      on_arc_(!bodies.has_wall && bodies.first.outline.empty() && bodies.second.outline.empty()) {
  kind_ = s.path == "approach"    ? Kind::approach
          : s.path == "slide"     ? Kind::slide
          : s.path == "roll"      ? Kind::roll
          : s.path == "waypoints" ? Kind::waypoints
                                  : Kind::ellipse;
  if (kind_ == Kind::approach) return;
  if (kind_ != Kind::waypoints) start_.x += depth_;
  if (kind_ == Kind::roll) {
    const PairForces f =
        bodies.contact()->at(bodies.state_of_first(start_), bodies.state_of_second(), 0);
    arm_ = f.touching ? std::hypot(f.point.x() - start_.x, f.point.y() - start_.y) : radius_;
  }
  for (std::size_t k = 0; kind_ == Kind::waypoints && k + 2 < s.waypoints.size(); k += 3) {
    waypoints_.push_back({start_.x + radius_ * s.waypoints[k],
                          start_.y + radius_ * s.waypoints[k + 1], s.waypoints[k + 2]});
  }
}

PairPath::PairPath(const PairSetup& s, Random& random, bool crossing) : radius_(s.radius) {
  at_wall_ = s.partner == "wall";
  const double other = s.radius_second > 0 && !at_wall_ ? s.radius_second : s.radius;
  const double unit = 0.5 * (s.radius + other);
  const double away = unit * (crossing ? random.uniform(0, 1) : random.uniform(1.2, 1.8));
  const auto [c, sine] = rotation_of(random.uniform(0, kTwoPi));
  along_ = unit * random.uniform(0.05, 0.4);
  across_ = unit * random.uniform(0.05, 0.4);
  start_ = {away * c, away * sine, random.uniform(0, kTwoPi)};
  swing_ = random.uniform(0, 1);
  phase_ = random.uniform(0, kTwoPi);
  rounds_ = random.uniform() < 0.2 ? 1 : 0;
  if (at_wall_) start_.x = -std::fabs(start_.x);
}

PairPose PairPath::at(double t) const {
  PairPose p = start_;
  const auto [c, s] = rotation_of(kTwoPi * t * turns_);
  switch (kind_) {
    case Kind::approach:
      p.x += 0.5 * depth_ * (1 - c);
      break;
    case Kind::slide:
      if (on_arc_) {
        const double distance = std::hypot(start_.x, start_.y);
        const auto [cosine, sine] = rotation_of(along_ * s / distance);
        p.x = cosine * start_.x - sine * start_.y;
        p.y = sine * start_.x + cosine * start_.y;
      } else {
        p.y += along_ * s;
      }
      break;
    case Kind::roll:
      if (at_wall_) {
        p.y += arm_ * swing_ * s;
        p.angle -= swing_ * s;
      } else {
        const double distance = std::hypot(start_.x, start_.y), turn = swing_ * s;
        const auto [cosine, sine] = rotation_of(turn);
        p.x = cosine * start_.x - sine * start_.y;
        p.y = sine * start_.x + cosine * start_.y;
        p.angle += turn * distance / arm_;
      }
      break;
    case Kind::ellipse: {
      const auto [round_c, round_s] = rotation_of(kTwoPi * t);
      p.x += along_ * round_c;
      p.y += across_ * round_s;
      p.angle += kTwoPi * rounds_ * t + swing_ * rotation_of(kTwoPi * t + phase_).sine;
      break;
    }
    case Kind::waypoints: {
      const double place = t * static_cast<double>(waypoints_.size() - 1);
      const auto k = std::min(static_cast<std::size_t>(place), waypoints_.size() - 2);
      const double share = place - static_cast<double>(k);
      const PairPose &a = waypoints_[k], &b = waypoints_[k + 1];
      return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
              a.angle + share * (b.angle - a.angle)};
    }
  }
  return p;
}

double PairPath::length(int steps) const {
  double sum = 0;
  PairPose last = at(0);
  for (int k = 1; k <= steps; ++k) {
    const PairPose now = at(static_cast<double>(k) / steps);
    sum += std::hypot(now.x - last.x, now.y - last.y) + radius_ * std::fabs(now.angle - last.angle);
    last = now;
  }
  return sum;
}

bool PairPath::closed() const {
  if (kind_ != Kind::waypoints) return true;
  const PairPose &a = waypoints_.front(), &b = waypoints_.back();
  return a.x == b.x && a.y == b.y && a.angle == b.angle;
}

}  // namespace grainfield::dem
