"""A snapshot of grainfield as arrays, and what follows from its columns alone."""
import numpy as np


class Packing:
    def __init__(self, group):
        a = group.attrs
        self.name = group.name
        self.attributes = {k: (v.decode() if isinstance(v, bytes) else v) for k, v in a.items()}
        self.dim = int(a["dim"])
        self.gravity = np.array([a[f"gravity_{c}"] for c in "xyz"])
        g, c, w = group["grains"], group["contacts"], group["walls"]
        self.columns = {f"{part}/{name}": np.array(group[part][name])
                        for part in ("grains", "contacts", "walls") for name in group[part]}
        self.tables = {name: {column: np.array(data) for column, data in table.items()}
                       for name, table in group.get("tables", {}).items()}
        n = g["id"].shape[0]
        self.position, self.velocity = np.array(g["position"]), np.array(g["velocity"])
        self.radius, self.mass = np.array(g["radius"]), np.array(g["mass"])
        self.volume = np.array(g["volume"])
        self.fixed = np.array(g["fixed"]) != 0
        self.rotates = self.columns.get("grains/rotates", np.ones(n)) != 0
        if self.dim == 2:
            self.spin = np.zeros((n, 3))
            self.spin[:, 2] = g["spin"]
            self.moments = np.repeat(np.array(g["inertia"])[:, None], 3, axis=1)
            self.angle = np.array(g["angle"])
        else:
            self.spin = np.array(g["angular_velocity"])
            self.moments = np.array(g["moments"])
            self.turn = rotations(np.array(g["orientation"]))
        self.axes = self.columns.get("grains/axes")
        if self.axes is not None and not self.axes.any():
            self.axes = None
        self.exponents = self.columns.get("grains/exponents")
        self.outlines = [None] * n
        if "grains/outline" in self.columns:
            start = self.columns["grains/outline_start"]
            for k in range(n):
                corners = self.columns["grains/outline"][start[k]:start[k + 1]]
                if len(corners):
                    co, si = np.cos(self.angle[k]), np.sin(self.angle[k])
                    self.outlines[k] = corners @ np.array([[co, si], [-si, co]])
        self.i, self.j = np.array(c["i"]), np.array(c["j"])
        self.point, self.normal = np.array(c["point"]), np.array(c["normal"])
        self.force = np.array(c["force"])
        self.normal_force = np.array(c["normal_force"])
        self.tangential_force = np.array(c["tangential_force"])
        self.friction = np.array(c["friction"])
        self.sliding = np.array(c["sliding"]) != 0
        m = len(self.i)
        tangent = np.stack([-self.normal[:, 1], self.normal[:, 0], 0 * self.normal[:, 0]], axis=1)
        self.tangent = tangent
        self.spring = (np.array(c["spring"])[:, None] * tangent if self.dim == 2
                       else np.array(c["spring_vector"]))
        self.rolling = self.columns.get("contacts/rolling_spring", np.zeros((m, 3)))
        self.twisting = self.columns.get("contacts/twisting_spring", np.zeros(m))
        self.image = self.columns.get("contacts/image", np.zeros((m, 3)))
        names = w.attrs["names"]
        names = names.decode() if isinstance(names, bytes) else names
        self.wall_names = names.split(",") if names else []
        self.wall_point, self.wall_normal = np.array(w["point"]), np.array(w["normal"])
        walls = len(self.wall_names)
        self.wall_velocity = self.columns.get("walls/velocity", np.zeros((walls, 3)))
        self.wall_spin = self.columns.get("walls/angular_velocity", np.zeros((walls, 3)))
        self.wall_force = self.columns.get("walls/force")
        shapes = w.attrs.get("shape_names", b"plane")
        shapes = (shapes.decode() if isinstance(shapes, bytes) else shapes).split(",")
        kind = self.columns.get("walls/shape", np.zeros(walls, int)).astype(int)
        self.plane = np.array([shapes[k] == "plane" for k in kind], bool)
        self.periodic = np.zeros(3, bool)
        self.edges, self.flow, self.low = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(3)
        if "cell" in group:
            cell = group["cell"]
            self.periodic = np.array(cell["periodic"]) != 0
            self.edges, self.flow = np.array(cell["edges"]), np.array(cell["velocity_gradient"])
            self.low = np.array(cell["low"])
        self.load = np.zeros((n, 3))
        loaded = int(a["loaded_grain"])
        if loaded >= 0:
            force = np.array([a[f"applied_force_{c}"] for c in "xyz"])
            also = [int(k) for k in self.attributes.get("also_loaded", "").split()]
            self.load[[loaded] + also] = force

    @property
    def size(self):
        return len(self.radius)

    def pairs(self):
        return self.j >= 0

    def wall_of(self, k):
        return -1 - int(self.j[k])

    def shift(self, image):
        """Of an image, m."""
        return np.asarray(image, float) @ self.edges

    def other_centre(self, k):
        """Centre of the second grain of contact k, as the first one sees it."""
        return self.position[self.j[k]] + self.shift(self.image[k])

    def free(self):
        return ~self.fixed

    def weight(self):
        return self.mass[:, None] * self.gravity

    def resultants(self):
        """Of all that acts on each grain: forces and moments about its centre (springs of rolling
        and twisting without their dashpots)."""
        force = np.zeros((self.size, 3))
        moment = np.zeros((self.size, 3))
        for k in range(len(self.i)):
            i, j, f, p = self.i[k], self.j[k], self.force[k], self.point[k]
            force[i] += f
            moment[i] += np.cross(p - self.position[i], f)
            near = self.radius[i]
            if j >= 0:
                force[j] -= f
                moment[j] -= np.cross(p - self.other_centre(k), f)
                near = near * self.radius[j] / (near + self.radius[j])
            held = near * np.cross(self.normal[k], self.rolling[k]) + self.twisting[k] * self.normal[k]
            moment[i] += held
            if j >= 0:
                moment[j] -= held
        return force + self.weight() + self.load, moment

    def fluctuation(self):
        return self.velocity - (self.position - self.low) @ self.flow.T

    def kinetic_energy(self):
        spin = self.spin
        if self.dim == 3:
            spin = np.einsum("kba,kb->ka", self.turn, self.spin)
        each = 0.5 * self.mass * (self.fluctuation()**2).sum(axis=1)
        each += 0.5 * (self.moments * spin**2).sum(axis=1)
        return each[self.free()].sum()

    def volume_of_sample(self):
        """Of the cell, or of the box between pairs of parallel planes."""
        d = self.dim
        if self.periodic[:d].all():
            return abs(np.linalg.det(self.edges[:d, :d]))
        normals, widths, taken = [], [], set()
        for a in range(len(self.wall_names)):
            for b in range(a + 1, len(self.wall_names)):
                if a in taken or b in taken:
                    continue
                if self.wall_normal[a] @ self.wall_normal[b] < -1 + 1e-9:
                    taken |= {a, b}
                    normals.append(self.wall_normal[a][:d])
                    widths.append((self.wall_point[b] - self.wall_point[a]) @ self.wall_normal[a])
        if len(widths) != d:
            return float("nan")
        return np.prod(widths) / abs(np.linalg.det(np.array(normals)))

    def branches(self):
        out = np.empty((len(self.i), 3))
        for k in range(len(self.i)):
            end = self.other_centre(k) if self.j[k] >= 0 else self.point[k]
            out[k] = end - self.position[self.i[k]]
        return out

    def stress(self):
        """sum f l / V, tension positive."""
        return self.force.T @ self.branches() / self.volume_of_sample()


def rotations(quaternion):
    """Body to space, of unit quaternions w x y z."""
    w, x, y, z = quaternion.T
    return np.stack([
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1),
    ], axis=1)
