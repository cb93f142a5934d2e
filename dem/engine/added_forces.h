// Forces of the caller's own, beside those of the laws: a function that an engine calls every n
// steps. It sees the grains once they have moved, with the velocities that the laws see (Verlet: of
// the half step), before contacts are evaluated. What it returns acts until the next call.
//
// An interface beside Engine, because runs without such forces need not know of it.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/engine/engine.h"

namespace grainfield::dem {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The grains at a moment, fixed ones too; row k is the grain with id k.
struct GrainsNow {
  double time = 0;                  ///< s
  RowMatrix positions, velocities;  ///< n x dim: m, m/s
  RowMatrix spins;                  ///< n x 1, in space n x 3: rad/s
  Eigen::VectorXd radii, masses;    ///< m, kg
};

/// The contacts of bodies that overlap, in the engine's order.
struct ContactsNow {
  std::vector<std::int64_t> i, j;  ///< ids, i < j; j = -1 - w: wall w
  RowMatrix points, normals;       ///< m x dim: m; unit, from i to j
  RowMatrix velocities;            ///< m x dim: of i against j at the contact point, m/s
  Eigen::VectorXd overlaps;        ///< m
  Eigen::VectorXd radii;           ///< r_i r_j/(r_i + r_j), at a wall r_i, m
};

class AddedForce {
 public:
  /// `every`: steps from one call to the next. Throws std::invalid_argument for less than 1 and for
  /// a name that is empty or has commas or control characters.
  AddedForce(std::string name, long every);
  virtual ~AddedForce() = default;

  const std::string& name() const { return name_; }
  long every() const { return every_; }
  /// It acts in contacts: at the contact point, on i, and on j the opposite.
  virtual bool in_contacts() const = 0;

  struct Loads {
    RowMatrix forces;   ///< N: n x dim on the grains, or m x dim in the contacts
    RowMatrix torques;  ///< N m, as GrainsNow::spins, on the grains; empty: none
  };
  /// What it returns counts only if it has these shapes and finite numbers: else the step throws
  /// std::invalid_argument naming the force and the grain. `contacts`: null unless in_contacts().
  /// The engine does not write to either as long as somebody else holds it. What it throws, the
  /// step throws.
  virtual Loads loads(const std::shared_ptr<const GrainsNow>& grains,
                      const std::shared_ptr<const ContactsNow>& contacts) = 0;

 private:
  std::string name_;
  long every_;
};

class TakesAddedForces {
 public:
  virtual ~TakesAddedForces() = default;

  /// From the next step on, in the place of one with the same name. All grains stay awake: throws
  /// std::invalid_argument while grains may sleep or the cell flows, and Engine::set_sleep and
  /// set_velocity_gradient throw as long as it acts.
  ///
  /// When Engine::step() throws what the function has thrown, its last step is whole: made with
  /// what the function returned before. Contact forces, walls' forces and stresses of the engine
  /// and its snapshots contain what acts in contacts. Snapshots have the attribute "added_forces".
  /// Checkpoints hold what acts now: restore() needs the same forces and throws
  /// std::invalid_argument without them.
  virtual void add_force(std::shared_ptr<AddedForce> force) = 0;
  /// Throws std::invalid_argument when there is no such force.
  virtual void remove_force(const std::string& name) = 0;
  /// Those that act.
  virtual std::vector<std::string> added_forces() const = 0;
  /// Snapshots say of these that they acted before: attribute "former_added_forces".
  virtual void mark_former_forces(const std::vector<std::string>& names) = 0;
};

/// That of an engine of make_engine.
TakesAddedForces& added_forces(Engine& engine);

/// Throws std::invalid_argument naming the force unless its loads fit `rows` grains or contacts and
/// are finite. `ids`: of the rows, to name the grain; null: row k is grain k.
void check_loads(const AddedForce& force, const AddedForce::Loads& loads, Eigen::Index rows,
                 int dim, double time, const std::vector<std::int64_t>* ids);
/// Throw std::invalid_argument: the two do not go together.
[[noreturn]] void refuse_sleep_with_added_forces();
[[noreturn]] void refuse_flow_with_added_forces();
/// "NAME every 3 steps"
std::string every_text(const std::string& name, long every);
/// Throws std::invalid_argument: a checkpoint needs these forces.
[[noreturn]] void refuse_without_forces(const std::string& needed, const std::string& found);

}  // namespace grainfield::dem
