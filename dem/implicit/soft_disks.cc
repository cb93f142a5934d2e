#include "dem/implicit/soft_disks.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "dem/checkpoint/checkpoint.h"
#include "dem/implicit/soft_checks.h"
#include "dem/implicit/soft_work.h"

namespace grainfield::dem {

void SoftDisks::Work::add(const Body<2>& disk) {
  if (!pending_.empty()) throw std::logic_error("a disk is added between whole steps");
  std::vector<Body<2>> all = bodies_;
  all.push_back(disk);
  check_soft(scene_, all, settings_);
  bodies_ = std::move(all);
  angles_.push_back(0);
  acting_.push_back(1);
  if (takes_end()) last_.emplace_back();
  widest_ = std::max(widest_, disk.radius);
  // The next step makes a new list.
  margin_ = -1;
  listed_.clear();
}

SoftEnergy SoftDisks::Work::energy() const {
  SoftEnergy out;
  for (const Body<2>& b : bodies_) {
    if (b.inverse_mass > 0) {
      out.kinetic += 0.5 * plain(b.velocity).squaredNorm() / b.inverse_mass;
      out.potential -= plain(scene_.gravity).dot(plain(b.position)) / b.inverse_mass;
    }
    if (b.inverse_inertia > 0) out.kinetic += 0.5 * b.spin * b.spin / b.inverse_inertia;
  }
  for (const SoftCandidate& c : candidates_) {
    if (!acts(c)) continue;
    const SoftLaw& law = law_of(c);
    const double s = std::max(overlap(c), 0.0);
    out.elastic += 0.5 * law.stiffness * s * s;
    if (law.tangential_stiffness > 0) {
      out.springs += 0.5 * c.memory.spring * c.memory.spring / law.tangential_stiffness;
    }
  }
  return out;
}

std::vector<SoftTouch> SoftDisks::Work::touches() const {
  std::vector<SoftTouch> out;
  for (const SoftCandidate& c : candidates_) {
    SoftTouch t;
    t.i = c.i;
    t.j = c.j;
    t.overlap = overlap(c);
    if (!(t.overlap > 0) || !acts(c)) continue;
    if (c.j < 0) {
      t.normal = -scene_.walls[static_cast<std::size_t>(-1 - c.j)].normal;
    } else {
      const Vec way = plain(bodies_[c.j].position - bodies_[c.i].position);
      t.normal = way / way.norm();
    }
    t.repulsion = law_of(c).stiffness * t.overlap;
    t.tangential = c.memory.spring + well_now(c);
    out.push_back(t);
  }
  return out;
}

SoftRest SoftDisks::Work::rest() const {
  std::vector<Vec> sums;
  for (const Body<2>& b : bodies_) {
    sums.push_back(b.inverse_mass > 0 ? Vec(plain(scene_.gravity) / b.inverse_mass) : Vec(0, 0));
  }
  SoftRest out;
  const std::vector<SoftTouch> all = touches();
  for (const SoftTouch& t : all) {
    const Vec force(-t.repulsion * t.normal.x() - t.tangential * t.normal.y(),
                    -t.repulsion * t.normal.y() + t.tangential * t.normal.x());
    out.mean_contact_force += force.norm() / static_cast<double>(all.size());
    sums[t.i] += force;
    if (t.j >= 0) sums[t.j] -= force;
  }
  int free = 0;
  for (int k = 0; k < count(); ++k) {
    if (!(bodies_[k].inverse_mass > 0)) continue;
    out.mean_unbalanced_force += sums[k].norm();
    ++free;
  }
  if (free > 0) out.mean_unbalanced_force /= free;
  out.ratio = all.empty() ? std::numeric_limits<double>::infinity()
                          : out.mean_unbalanced_force / out.mean_contact_force;
  return out;
}

std::string SoftDisks::Work::checkpoint() const {
  CheckpointWriter out;
  out.put(bodies_);
  out.put(angles_);
  out.put(acting_);
  out.put(listed_);
  out.put(pending_);
  out.put(last_);
  for (const double value : {time_, last_dt_, margin_, losses_.normal, losses_.tangential,
                             losses_.well, losses_.background, losses_.scheme, tally_.least_step}) {
    out.put(value);
  }
  for (const long value : {tally_.steps, tally_.solves, tally_.iterations, tally_.halved,
                           static_cast<long>(tally_.most_iterations)}) {
    out.put(static_cast<std::int64_t>(value));
  }
  out.put(static_cast<std::uint64_t>(candidates_.size()));
  for (const SoftCandidate& c : candidates_) {
    out.put(c.i);
    out.put(c.j);
    out.put(c.memory.spring);
    out.put(c.memory.rest);
    out.put(c.memory.whole);
    out.put(c.touched);
  }
  out.put(blocks_);
  return out.bytes();
}

void SoftDisks::Work::restore(const std::string& checkpoint) {
  CheckpointReader in(checkpoint);
  const std::size_t n = bodies_.size();
  in.get(bodies_);
  in.get(angles_);
  in.get(acting_);
  in.get(listed_);
  in.require(bodies_.size() == n && angles_.size() == n && acting_.size() == n &&
             (listed_.empty() || listed_.size() == n));
  in.get(pending_);
  in.get(last_);
  in.require(last_.size() == (takes_end() ? n : 0));
  in.require(std::all_of(pending_.begin(), pending_.end(), [&](int halvings) {
    return halvings >= 0 && halvings <= settings_.most_halvings;
  }));
  for (double* value : {&time_, &last_dt_, &margin_, &losses_.normal, &losses_.tangential,
                        &losses_.well, &losses_.background, &losses_.scheme, &tally_.least_step}) {
    in.get(*value);
  }
  std::int64_t counts[5];
  for (std::int64_t& value : counts) in.get(value);
  tally_.steps = counts[0];
  tally_.solves = counts[1];
  tally_.iterations = counts[2];
  tally_.halved = counts[3];
  tally_.most_iterations = static_cast<int>(counts[4]);
  std::uint64_t found = 0;
  in.get(found);
  in.require(found <= checkpoint.size());
  candidates_.assign(found, SoftCandidate());
  for (SoftCandidate& c : candidates_) {
    in.get(c.i);
    in.get(c.j);
    in.get(c.memory.spring);
    in.get(c.memory.rest);
    in.get(c.memory.whole);
    in.get(c.touched);
    in.require(c.i >= 0 && c.i < count() && c.j < count() &&
               c.j >= -static_cast<int>(scene_.walls.size()));
  }
  in.get(blocks_);
  in.require(std::is_sorted(blocks_.begin(), blocks_.end()) &&
             std::all_of(blocks_.begin(), blocks_.end(), [&](const auto& pair) {
               return pair.first >= 0 && pair.first < count() && pair.second >= 0 &&
                      pair.second < count() && pair.first != pair.second;
             }));
  in.finish();
  matrix_ = {};
  lay_out();
}

SoftDisks::SoftDisks(const SoftScene& scene, const std::vector<Body<2>>& disks,
                     const ImplicitSettings& settings)
    : work_(std::make_unique<Work>(scene, disks, settings)) {}
SoftDisks::~SoftDisks() = default;
SoftDisks::SoftDisks(SoftDisks&&) noexcept = default;
SoftDisks& SoftDisks::operator=(SoftDisks&&) noexcept = default;

void SoftDisks::step(long steps) { work_->step(steps); }
bool SoftDisks::try_part() { return work_->try_part(); }
void SoftDisks::set_acting(const std::vector<char>& acting) { work_->set_acting(acting); }
void SoftDisks::add(const Body<2>& disk) { work_->add(disk); }
void SoftDisks::set_velocities(const std::vector<Body<2>>& bodies) {
  work_->set_velocities(bodies);
}
double SoftDisks::time() const { return work_->time(); }
const std::vector<Body<2>>& SoftDisks::bodies() const { return work_->bodies(); }
const std::vector<double>& SoftDisks::angles() const { return work_->angles(); }
SoftEnergy SoftDisks::energy() const { return work_->energy(); }
const SoftLosses& SoftDisks::losses() const { return work_->losses(); }
const ImplicitTally& SoftDisks::tally() const { return work_->tally(); }
std::vector<SoftTouch> SoftDisks::touches() const { return work_->touches(); }
SoftRest SoftDisks::rest() const { return work_->rest(); }
std::string SoftDisks::checkpoint() const { return work_->checkpoint(); }
void SoftDisks::restore(const std::string& checkpoint) { work_->restore(checkpoint); }

}  // namespace grainfield::dem
