#include "dem/shapes/common_normal.h"

#include <algorithm>
#include <cmath>

#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;

// Steps from a start; more are taken where flat faces lie on each other only.
constexpr int kMostEvaluations = 100;
// A step goes at most so far, rad, and is shortened by this factor until f falls as it should.
constexpr double kLongestStep = 0.5, kShorten = 0.25, kArmijo = 1e-4;
constexpr int kMostShortened = 25;
// f is not known better than to this share of both sizes.
constexpr double kRoundOff = 4e-16;
// From a saddle it goes on by this angle, rad.
constexpr double kOffSaddle = 0.01;
// Bodies that overlap by more than this share of the smaller one's least extent, and have no
// memory, are looked at from their axes, too; and those with an exponent above kSharp, at whose
// edges shallow overlaps have several leasts, whenever they come into touch.
constexpr double kDeep = 0.05, kSharp = 1.3;
// Below e = 2/3 the surface's points go with n's components by a power e/(2 - e) < 1/2, for which
// Newton's method in n runs away.
constexpr double kSteepPower = 0.5;
// Such components count where they are at most kSmall; below kMiddle the point is in the middle of
// a face. kFine: what rounding leaves of a component in another frame, and more. Axes with a
// greater cosine than kParallel are one. kLeastRest: squared, of n out of both axes' plane.
constexpr double kSmall = 0.7, kMiddle = 1e-40, kFine = 1e-10, kParallel = 0.9, kLeastRest = 0.05;
constexpr double kLongestChange = 0.2;

struct View {
  Vector3d in_i, in_j;  // n in the bodies' frames: components near 0 are not lost in each other
  Vector3d n;           // in space
};

View view_of(const TurnedBody& i, const TurnedBody& j, const Vector3d& n) {
  return {i.turn.transpose() * n, j.turn.transpose() * n, n};
}

/// f with its derivatives.
struct Look {
  Support i, j;  // in the bodies' frames
  double f = 0;
  Vector3d x_i, x_j;  // points of the surfaces, from their own centres; x_j that of n
  Vector3d gradient;  // across n
  std::array<Square, 4> bend;
};

Look look(const TurnedBody& i, const TurnedBody& j, const Vector3d& across, const View& v) {
  Look out;
  out.i = support_of(i.shape, v.in_i);
  out.j = support_of(j.shape, v.in_j);
  const Support &a = out.i, &b = out.j;
  out.f = a.height + b.height - v.n.dot(across);
  out.x_i = i.turn * a.point;
  out.x_j = j.turn * b.point;
  const Vector3d all = out.x_i + out.x_j - across;
  out.gradient = all - v.n.dot(all) * v.n;
  for (int k = 0; k < 2; ++k) {
    out.bend[k] = {a.bend[k].weight, i.turn * a.bend[k].along};
    out.bend[2 + k] = {b.bend[k].weight, j.turn * b.bend[k].along};
  }
  return out;
}

/// H u of some of the squares.
Vector3d bent(const Square* squares, const Vector3d& u) {
  return squares[0].weight * squares[0].along.dot(u) * squares[0].along +
         squares[1].weight * squares[1].along.dot(u) * squares[1].along;
}

/// -(H + shift)^-1 g across n, or a part of it.
struct Step {
  Vector3d by = Vector3d::Zero();
  bool least = false;  // f is least where it leads: the Hessian is positive
  double shift = 0, divisor = 0;
  double share = 1;

  Step scaled(double factor) const { return {factor * by, least, shift, divisor, factor * share}; }
};

/// The determinant is a sum of positive terms, and the adjugate turns every square by a right
/// angle.
Step newton_step(const Look& at, const Vector3d& n) {
  double trace = 0, determinant = 0;
  Vector3d adjugate = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) {
    const auto& [weight, along] = at.bend[k];
    trace += weight * along.squaredNorm();
    const Vector3d turned = n.cross(along);
    adjugate += weight * turned.dot(at.gradient) * turned;
    for (int l = 0; l < k; ++l) {
      const double area = turned.dot(at.bend[l].along);
      determinant += weight * at.bend[l].weight * area * area;
    }
  }
  const double f = at.f;
  Step step;
  step.least = determinant - f * trace + f * f > 0 && trace > 2 * f;
  step.shift = step.least ? -f : std::fabs(f);
  step.divisor = determinant + step.shift * trace + step.shift * step.shift;
  step.by = -(adjugate + step.shift * at.gradient) / step.divisor;
  return step;
}

/// The component of a step along an axis of body `number`. In space it may be lost: of a square of
/// 1e30 that lies along the axis its rounding errors alone would be left.
double along_axis(const Step& step, const Look& at, const View& v, const TurnedBody& body,
                  int number, int axis) {
  if (!(step.divisor > 0)) return step.by.dot(body.turn.col(axis));
  const Vector3d& in_body = number == 0 ? v.in_i : v.in_j;
  const Support& own = number == 0 ? at.i : at.j;
  double sum = step.shift * at.gradient.dot(body.turn.col(axis));
  for (int k = 0; k < 4; ++k) {
    const Vector3d turned = v.n.cross(at.bend[k].along);
    const double pull = at.bend[k].weight * turned.dot(at.gradient);
    sum += pull * (k / 2 == number ? in_body.cross(own.bend[k % 2].along)[axis]
                                   : turned.dot(body.turn.col(axis)));
  }
  return -step.share * sum / step.divisor;
}

/// sgn(1 + x) |1 + x|^power.
double power_of_sum(double x, double power) {
  const double y = 1 + x;
  if (y == 0) return 0;
  return std::copysign(exponential(power * natural_log(std::fabs(y))), y);
}

/// A component of n along an axis of a body by which a surface point goes with a power below 1/2.
struct Steep {
  int body = -1, axis = 0;  // -1: none
  double power = 1, value = 0, change = 0;
  Vector3d along;  // the axis in space
  double score = 0;

  /// Straight in the point's coordinate y, value ~ y^(1/power), so that one step finds a value of
  /// any size.
  double changed() const {
    if (std::fabs(value) < kMiddle) return std::copysign(kMiddle, change);
    const double there = value * power_of_sum(power * change / value, 1 / power);
    return std::min(std::max(there, value - kLongestChange), value + kLongestChange);
  }
};

/// Least of the powers by which points go with n's components; and of each component where
/// component k is the greatest.
double steepest_power(const Superellipsoid& b) { return std::min(b.level, b.upright) - 1; }
double power_at(const Superellipsoid& b, int component, int k) {
  if (component == 2) return b.upright - 1;
  return k == 2 ? std::min(b.level, b.upright) - 1 : b.level - 1;
}

/// The steepest component of n for a step; its axis not that of `other`.
void find_steep(const TurnedBody& body, int number, const View& view, const Look& at,
                const Step& step, const Steep& other, Steep& best) {
  const Vector3d& n = number == 0 ? view.in_i : view.in_j;
  if (steepest_power(body.shape) >= kSteepPower) return;
  int greatest = 0;
  body.shape.axes.cwiseProduct(n).cwiseAbs().maxCoeff(&greatest);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == greatest || std::fabs(n[axis]) > kSmall) continue;
    Steep s;
    s.power = power_at(body.shape, axis, greatest);
    if (s.power >= kSteepPower) continue;
    s.body = number;
    s.axis = axis;
    s.along = body.turn.col(axis);
    if (other.body >= 0 && std::fabs(s.along.dot(other.along)) > kParallel) continue;
    s.value = n[axis];
    s.change = along_axis(step, at, view, body, number, axis);
    s.score = (std::fabs(s.change) + kFine) / (std::fabs(s.value) + kMiddle);
    if (s.score > best.score) best = s;
  }
}

View stepped(const TurnedBody& i, const TurnedBody& j, const View& from, const Look& at,
             const Step& step) {
  const Vector3d& by = step.by;
  const View straight = view_of(i, j, (from.n + by).normalized());
  const auto steep = [&](const Steep& other) {
    Steep best;
    find_steep(i, 0, from, at, step, other, best);
    find_steep(j, 1, from, at, step, other, best);
    return best;
  };
  const Steep first = steep({});
  if (first.body < 0) return straight;
  // n from its two steepest components, or one and what is across it.
  const Steep second = steep(first);
  const Vector3d& a = first.along;
  const Vector3d b = second.body >= 0 ? second.along : Vector3d(from.n.cross(a).normalized());
  const double on_a = first.changed();
  const double on_b = second.body >= 0 ? second.changed() : b.dot(by);
  const double same = a.dot(b), apart = 1 - same * same;
  const Vector3d within = ((on_a - on_b * same) / apart) * a + ((on_b - on_a * same) / apart) * b;
  const double rest = 1 - within.squaredNorm();
  if (!(rest > kLeastRest)) return straight;
  const Vector3d across = a.cross(b) / std::sqrt(apart);
  const Vector3d n = within + std::copysign(std::sqrt(rest), across.dot(from.n)) * across;
  View out = view_of(i, j, n.normalized());
  for (const Steep* s : {&first, &second}) {
    if (s->body < 0) continue;
    (s->body == 0 ? out.in_i : out.in_j)[s->axis] = s == &first ? on_a : on_b;
  }
  return out;
}

/// `n` not further than kMostTurn from `start`.
Vector3d turned_at_most(const Vector3d& start, const Vector3d& n) {
  const Rotation most = rotation_of(kMostTurn);
  if (start.dot(n) >= most.cosine) return n;
  Vector3d way = n - start.dot(n) * start;
  if (!(way.squaredNorm() > 0)) way = start.unitOrthogonal();
  return most.cosine * start + most.sine * way.normalized();
}

class Descent {
 public:
  Descent(const TurnedBody& i, const TurnedBody& j, const Vector3d& across)
      : i_(i), j_(j), across_(across), size_(i.farthest + j.farthest) {}

  /// Follows f down from n; `bound`: not further than kMostTurn. False when the bodies are apart.
  bool descend(const Vector3d& start, bool bound, CommonNormal& out) {
    View view = view_of(i_, j_, start);
    Look at = evaluate(view);
    for (;;) {
      if (!(at.f > 0)) return apart(view, at, out);
      const Step step = newton_step(at, view.n);
      const double fall = -at.gradient.dot(step.by);  // twice what f loses
      if (step.least && fall <= kDepthLeft * at.f &&
          at.gradient.squaredNorm() <= kPointsLeft * kPointsLeft * size_ * size_) {
        return settle(view, at, step.by, start, bound, out);
      }
      if (evaluations_ >= kMostEvaluations) break;
      Step next = step;
      if (!step.least && step.by.squaredNorm() < kOffSaddle * kOffSaddle) {
        next = {off_saddle(at, view.n)};
      }
      const double length = next.by.norm();
      if (length > kLongestStep) next = next.scaled(kLongestStep / length);
      if (!go(next, view, at)) break;  // f falls no more: round-off
      if (bound && start.dot(view.n) < rotation_of(kMostTurn).cosine) {
        view = view_of(i_, j_, turned_at_most(start, view.n));
        at = evaluate(view);
        if (!(at.f > 0)) return apart(view, at, out);
        tell(view.n, at, Vector3d::Zero(), false, out);
        return true;
      }
    }
    const Step step = newton_step(at, view.n);
    const bool small = step.by.squaredNorm() < 1e-12;
    tell(view.n, at, small ? step.by : Vector3d::Zero(), small, out);
    return true;
  }

 private:
  Look evaluate(const View& view) {
    ++evaluations_;
    return look(i_, j_, across_, view);
  }
  static bool apart(const View& view, const Look& at, CommonNormal& out) {
    out.normal = view.n;
    out.depth = at.f;
    return false;
  }

  /// One step along `by`, shortened until f falls.
  bool go(Step step, View& view, Look& at) {
    for (int k = 0; k < kMostShortened; ++k) {
      const View next = stepped(i_, j_, view, at, step);
      const Look there = evaluate(next);
      const double slope = std::min(at.gradient.dot(step.by), 0.0);
      if (there.f <= at.f + kArmijo * slope + kRoundOff * size_) {
        const bool moves = there.f < at.f || (next.n - view.n).squaredNorm() > 0;
        view = next;
        at = there;
        return moves;
      }
      step = step.scaled(kShorten);
    }
    return false;
  }

  /// Where f has no slope, or falls by less than it should, along the direction of least curvature.
  Vector3d off_saddle(const Look& at, const Vector3d& n) const {
    const Principal p = principal_of(n, at.bend.data(), 4);
    const Vector3d way = n.cross(p.along);
    return (at.gradient.dot(way) > 0 ? -kOffSaddle : kOffSaddle) * way;
  }

  bool settle(const View& view, const Look& at, const Vector3d& by, const Vector3d& start,
              bool bound, CommonNormal& out) {
    tell(view.n, at, by, true, out);
    if (bound) out.normal = turned_at_most(start, out.normal);
    return true;
  }

  void tell(const Vector3d& n, const Look& at, const Vector3d& by, bool settled,
            CommonNormal& out) {
    out.normal = (n + by).normalized();
    out.depth = at.f + 0.5 * at.gradient.dot(by);
    const Vector3d on_i = at.x_i + bent(&at.bend[0], by);
    const Vector3d on_j = across_ - at.x_j - bent(&at.bend[2], by);
    out.point = 0.5 * (on_i + on_j);
    const Tangents t = tangents_of(n);
    set_curvatures(relative_curvatures(bend_of(at.i, i_.in_body(t)), bend_of(at.j, j_.in_body(t))),
                   t, out);
    out.settled = settled;
    out.evaluations = evaluations_;
  }

  static void set_curvatures(const PlanePrincipal& relative, const Tangents& t, CommonNormal& out) {
    out.lesser_curvature = relative.lesser;
    out.greater_curvature = relative.greater;
    out.major = across_of(relative, t);
  }

  const TurnedBody &i_, &j_;
  const Vector3d across_;
  const double size_;
  int evaluations_ = 0;
};

bool is_sharp(const Superellipsoid& b) { return std::max(b.exponents[0], b.exponents[1]) > kSharp; }

/// From the axes of both bodies, towards the other one; keeps the least depth.
bool search_everywhere(Descent& search, const TurnedBody& i, const TurnedBody& j,
                       const Vector3d& across, CommonNormal& best) {
  for (const TurnedBody* body : {&i, &j}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d way = body->turn.col(axis);
      CommonNormal other;
      if (!search.descend(way.dot(across) < 0 ? Vector3d(-way) : way, false, other)) {
        best = other;
        return false;
      }
      if (other.depth < best.depth) best = other;
    }
  }
  return true;
}

/// step_pairs of one pair.
Stepped step_alone(const TurnedBody& i, const TurnedBody& j, const Vector3d& across,
                   PairNormal& memory, CommonNormal& out, bool curvatures) {
  const LaneBody first = lane_body(i, 1), second = lane_body(j, 1);
  PairBatch pair;
  OverlapBatch o;
  pair.count = 1;
  pair.slots[0] = 0;
  pair.i[0] = &first;
  pair.j[0] = &second;
  pair.powers[0] = &memory.powers;
  pair.overlaps = &o;
  for (int k = 0; k < 3; ++k) {
    pair.across[k][0] = across[k];
    o.normal[k][0] = memory.normal[k];
  }
  step_pairs_of<2>(pair, curvatures);
  const auto vector = [](const double(&v)[3][kBatch]) {
    return Vector3d(v[0][0], v[1][0], v[2][0]);
  };
  const Stepped end = pair.ends[0];
  if (end == Stepped::neither) return end;
  memory.normal = vector(o.normal);
  out.depth = pair.height[0];
  if (end == Stepped::apart) return end;
  out.normal = memory.normal;
  out.depth = o.depth[0];
  out.point = vector(o.arm_i);
  out.settled = true;
  out.evaluations = pair.evaluations[0];
  if (curvatures) {
    out.lesser_curvature = o.lesser_curvature[0];
    out.greater_curvature = o.greater_curvature[0];
    out.major = vector(o.major);
  }
  return end;
}

}  // namespace

LaneBody lane_body(const TurnedBody& body, double equal_radius) {
  LaneBody out;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) out.turn[k][l] = body.turn(l, k);
    out.axes[k] = body.shape.axes[k];
  }
  out.level = body.shape.level;
  out.upright = body.shape.upright;
  out.farthest = body.farthest;
  out.equal_radius = equal_radius;
  return out;
}

double thickness(const TurnedBody& i, const TurnedBody& j, const Vector3d& across,
                 const Vector3d& n) {
  return height_of(i.shape, i.turn.transpose() * n) + height_of(j.shape, j.turn.transpose() * n) -
         n.dot(across);
}

bool common_normal(const TurnedBody& i, const TurnedBody& j, const Vector3d& across,
                   PairNormal& memory, CommonNormal& out, bool curvatures) {
  out.evaluations = 0;
  out.depth = 0;
  const double reach = i.farthest + j.farthest;
  if (across.squaredNorm() >= reach * reach) {
    memory.touching = 0;
    return false;
  }
  const bool knows = !memory.empty();
  if (!knows) {
    memory.normal =
        across.squaredNorm() > 0 ? Vector3d(across.normalized()) : Vector3d(i.turn.col(2));
  }
  if (memory.touching == 0) {
    out.depth = thickness(i, j, across, memory.normal);
    if (out.depth <= 0) return false;
  } else {
    const Stepped end = step_alone(i, j, across, memory, out, curvatures);
    memory.touching = end == Stepped::apart ? 0 : 1;
    if (end == Stepped::neither) return descend_on(i, j, across, memory, out);
    return end == Stepped::settled;
  }
  Descent search(i, j, across);
  bool touches = search.descend(memory.normal, false, out);
  const bool deep = !knows && out.depth > kDeep * std::min(i.nearest, j.nearest);
  const bool sharp = is_sharp(i.shape) || is_sharp(j.shape);
  if (touches && (deep || sharp)) touches = search_everywhere(search, i, j, across, out);
  memory.normal = out.normal;
  memory.touching = touches ? 1 : 0;
  return touches;
}

bool descend_on(const TurnedBody& i, const TurnedBody& j, const Vector3d& across,
                PairNormal& memory, CommonNormal& out) {
  const bool touches = Descent(i, j, across).descend(memory.normal, true, out);
  memory.normal = out.normal;
  memory.touching = touches ? 1 : 0;
  return touches;
}

}  // namespace grainfield::dem
