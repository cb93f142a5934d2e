#include "coupling/python/own_forces.h"

#include <memory>
#include <string>
#include <utility>

namespace grainfield::python {
namespace {

/// `from`, a member of what `owner` keeps alive; of one column a single axis.
py::array view_of(const dem::RowMatrix& from, const py::handle& owner) {
  const py::ssize_t rows = from.rows(), columns = from.cols();
  constexpr py::ssize_t size = sizeof(double);
  if (columns == 1) return view<double>(from.data(), {rows}, {size}, owner);
  return view<double>(from.data(), {rows, columns}, {columns * size, size}, owner);
}

template <class T>
py::capsule owner_of(const std::shared_ptr<const T>& held) {
  return py::capsule(new std::shared_ptr<const T>(held),
                     [](void* kept) { delete static_cast<std::shared_ptr<const T>*>(kept); });
}

py::dict arrays_of(const std::shared_ptr<const dem::GrainsNow>& grains) {
  const py::capsule owner = owner_of(grains);
  py::dict out;
  out["time"] = grains->time;
  out["positions"] = view_of(grains->positions, owner);
  out["velocities"] = view_of(grains->velocities, owner);
  out["spins"] = view_of(grains->spins, owner);
  out["radii"] = view(grains->radii, owner);
  out["masses"] = view(grains->masses, owner);
  return out;
}

py::dict arrays_of(const std::shared_ptr<const dem::ContactsNow>& contacts) {
  const py::capsule owner = owner_of(contacts);
  const auto ids = [&](const std::vector<std::int64_t>& from) {
    return view<std::int64_t>(from.data(), {static_cast<py::ssize_t>(from.size())},
                              {sizeof(std::int64_t)}, owner);
  };
  py::dict out;
  out["i"] = ids(contacts->i);
  out["j"] = ids(contacts->j);
  out["points"] = view_of(contacts->points, owner);
  out["normals"] = view_of(contacts->normals, owner);
  out["velocities"] = view_of(contacts->velocities, owner);
  out["overlaps"] = view(contacts->overlaps, owner);
  out["radii"] = view(contacts->radii, owner);
  return out;
}

class OwnForce final : public dem::AddedForce {
 public:
  OwnForce(const py::function& function, const std::string& name, long every, bool in_contacts)
      : AddedForce(name, every), function_(new py::function(function)), contacts_(in_contacts) {}
  ~OwnForce() override {
    const py::gil_scoped_acquire acquired;
    delete function_;
  }

  bool in_contacts() const override { return contacts_; }
  Loads loads(const std::shared_ptr<const dem::GrainsNow>& grains,
              const std::shared_ptr<const dem::ContactsNow>& contacts) override {
    const py::gil_scoped_acquire acquired;
    const py::object now = contacts ? py::object(arrays_of(contacts)) : py::none();
    const py::tuple made = (*function_)(arrays_of(grains), now);
    Loads out;
    out.forces = matrix_of(made[0], name() + ": forces");
    if (!made[1].is_none()) out.torques = matrix_of(made[1], name() + ": torques");
    return out;
  }

 private:
  py::function* function_;  // touched with Python's lock alone
  bool contacts_;
};

}  // namespace

std::shared_ptr<dem::AddedForce> own_force(const py::function& function, const std::string& name,
                                           long every, bool in_contacts) {
  return std::make_shared<OwnForce>(function, name, every, in_contacts);
}

}  // namespace grainfield::python
