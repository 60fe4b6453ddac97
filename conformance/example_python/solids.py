"""A program of level 3: equilibria and modes of elastic solids, from docs/guide/conformance.md alone.

    python solids.py {kind} {resolved} {out}

Ten-node or four-node tetrahedra of mesh.msh, St. Venant-Kirchhoff material, Newton's method. Needs numpy, scipy, meshio.
"""

import csv
import itertools
import json
import sys
from pathlib import Path

import meshio
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigsh, splu

AXES = "xyz"
# Rules of integration over the unit tetrahedron: barycentric coordinates and weights (their sum is the volume 1/6).
A, B = (5 - 5**0.5) / 20, (5 + 3 * 5**0.5) / 20
FOUR_POINTS = [[B if i == j else A for j in range(4)] for i in range(4)], [1 / 24] * 4
ONE_POINT = [[0.25] * 4], [1 / 6]


def rule_of_degree(points):
    """Gauss products on the collapsed cube: exact to degree 2 `points` - 3."""
    x, w = np.polynomial.legendre.leggauss(points)
    x, w = (x + 1) / 2, w / 2
    barycentric, weights = [], []
    for (a, wa), (b, wb), (c, wc) in itertools.product(zip(x, w), repeat=3):
        p = [a, b * (1 - a), c * (1 - a) * (1 - b)]
        barycentric.append([1 - sum(p), *p])
        weights.append(wa * wb * wc * (1 - a) ** 2 * (1 - b))
    return barycentric, weights


# Nodes in the middle of edges, in the order of meshio.
EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
GRADIENTS = np.array([[-1, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)


def shapes(nodes, barycentric):
    """Values (points x nodes) and gradients (points x nodes x 3) of the shape functions."""
    l = np.array(barycentric)
    if nodes == 4:
        return l, np.repeat(GRADIENTS[None], len(l), 0)
    values = [li * (2 * li - 1) for li in l.T] + [4 * l[:, i] * l[:, j] for i, j in EDGES]
    slopes = [(4 * l[:, i, None] - 1) * GRADIENTS[i] for i in range(4)]
    slopes += [4 * (l[:, i, None] * GRADIENTS[j] + l[:, j, None] * GRADIENTS[i]) for i, j in EDGES]
    return np.stack(values, 1), np.stack(slopes, 1)


class Mesh:
    def __init__(self, path):
        mesh = meshio.read(path)
        self.nodes = mesh.points
        self.kind = "tetra10" if "tetra10" in mesh.cells_dict else "tetra"
        self.elements = mesh.cells_dict[self.kind]
        self.sets, self.faces = {}, {}
        for name, blocks in mesh.cell_sets.items():
            for block, members in zip(mesh.cells, blocks):
                if name.startswith("gmsh:") or members is None or not len(members):
                    continue
                cells = block.data[members]
                if block.type.startswith("triangle"):
                    self.faces[name] = np.vstack([self.faces[name], cells]) if name in self.faces else cells
                known = self.sets.get(name, np.array([], int))
                self.sets[name] = np.union1d(known, cells.ravel())

    def at(self, rule):
        """Gradients with respect to places (elements x points x nodes x 3), weights times volumes, values."""
        values, slopes = shapes(self.elements.shape[1], rule[0])
        jacobian = np.einsum("pna,eni->epia", slopes, self.nodes[self.elements])
        inverse = np.linalg.inv(jacobian)
        volumes = np.linalg.det(jacobian) * np.array(rule[1])
        return np.einsum("pna,epai->epni", slopes, inverse), volumes, values

    def assemble(self, blocks):
        """Sparse matrix of blocks (elements x 3 nodes x 3 nodes)."""
        dofs = (3 * self.elements[:, :, None] + np.arange(3)).reshape(len(self.elements), -1)
        rows = np.repeat(dofs, dofs.shape[1], 1).ravel()
        columns = np.tile(dofs, (1, dofs.shape[1])).ravel()
        return sp.csc_matrix((blocks.ravel(), (rows, columns)), shape=(self.nodes.size,) * 2)


class Solid:
    def __init__(self, scene, folder):
        self.mesh, solid = Mesh(folder / "mesh.msh"), scene["solid"]
        self.scene, material = solid, solid["material"]
        e, nu, self.density = material["youngs_modulus"], material["poisson_ratio"], material["density"]
        self.lame = e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu)
        self.rule = ONE_POINT if self.mesh.kind == "tetra" else FOUR_POINTS
        self.gradients, self.volumes, _ = self.mesh.at(self.rule)

    def stress(self, u):
        """Deformation gradient, Green-Lagrange strain and second Piola-Kirchhoff stress at each point."""
        f = np.eye(3) + np.einsum("eni,epnj->epij", u[self.mesh.elements], self.gradients)
        strain = (np.einsum("epki,epkj->epij", f, f) - np.eye(3)) / 2
        trace = np.trace(strain, axis1=2, axis2=3)[..., None, None]
        return f, strain, self.lame[0] * trace * np.eye(3) + 2 * self.lame[1] * strain

    def forces(self, u):
        f, _, s = self.stress(u)
        of_elements = np.einsum("ep,epik,epkj,epnj->eni", self.volumes, f, s, self.gradients)
        total = np.zeros_like(u)
        np.add.at(total, self.mesh.elements, of_elements)
        return total

    def stiffness(self, u):
        (lame, shear), g = self.lame, self.gradients
        f, _, s = self.stress(u)
        b = np.einsum("epij,epnj->epni", f, g)  # change of the trace of the strain
        left = np.einsum("epik,epjk->epij", f, f)
        n = g.shape[2]
        blocks = lame * np.einsum("ep,epni,epmj->enimj", self.volumes, b, b, optimize=True)
        blocks += shear * np.einsum("ep,epnk,epmk,epij->enimj", self.volumes, g, g, left, optimize=True)
        blocks += shear * np.einsum("ep,epmi,epnj->enimj", self.volumes, b, b, optimize=True)
        plain = np.einsum("ep,epnk,epkl,epml->enm", self.volumes, g, s, g, optimize=True)
        for i in range(3):
            blocks[:, :, i, :, i] += plain
        return self.mesh.assemble(blocks.reshape(-1, 3 * n, 3 * n))

    def mass(self):
        _, volumes, values = self.mesh.at(rule_of_degree(5))
        n = values.shape[1]
        of_nodes = self.density * np.einsum("ep,pn,pm->enm", volumes, values, values, optimize=True)
        return self.mesh.assemble(np.einsum("enm,ij->enimj", of_nodes, np.eye(3)).reshape(-1, 3 * n, 3 * n))

    def supports(self):
        """Fixed coordinates, and what holds which of them."""
        held, of_sets = np.zeros(self.mesh.nodes.size, bool), {}
        for support in self.scene.get("fixed", []):
            for i, axis in enumerate(AXES):
                if axis not in support:
                    continue
                if support[axis] is not True:
                    not_claimed("a displacement that is not zero")
                own = 3 * self.mesh.sets[support["set"]] + i
                of_sets.setdefault(support["set"], {})[axis] = own[~held[own]]
                held[own] = True
        return held, of_sets

    def loads(self):
        total = np.zeros_like(self.mesh.nodes)
        for load in self.scene.get("load", []):
            force = np.array(load.get("force", [load.get(axis, 0.0) for axis in AXES]))
            if "pressure" in load or force.dtype == object:
                not_claimed("a pressure or a profile")
            name = load["set"]
            if name not in self.mesh.faces:
                nodes = self.mesh.sets[name]
                total[nodes] += force / len(nodes)
                continue
            # By area: a third at each corner of a straight face, or at each node in the middle of its edges.
            faces = self.mesh.faces[name]
            corners = self.mesh.nodes[faces[:, :3]]
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            area = np.linalg.norm(normal, axis=1) / 2
            for node in range(3, 6) if faces.shape[1] == 6 else range(3):
                np.add.at(total, faces[:, node], area[:, None] / area.sum() / 3 * force)
        return total

    def statics(self):
        held, of_sets = self.supports()
        free, loads = ~held, self.loads()
        u = np.zeros_like(self.mesh.nodes)
        for _ in range(50):
            residual = (loads - self.forces(u)).ravel()
            if np.abs(residual[free]).max() <= 1e-13 * np.abs(loads).max():
                break
            step = splu(self.stiffness(u)[free][:, free]).solve(residual[free])
            u.ravel()[free] += step
            if np.abs(step).max() <= 1e-14 * np.abs(u).max():
                break
        return u, loads, (self.forces(u) - loads).ravel(), of_sets

    def modes(self, count):
        held, _ = self.supports()
        free = ~held
        stiffness, mass = self.stiffness(np.zeros_like(self.mesh.nodes)), self.mass()
        stiffness, mass = stiffness[free][:, free], mass[free][:, free]
        # Shifted below zero, so that rigid motions are none; with vectors to spare for those that are alike.
        shift = -1e-5 * stiffness.diagonal().sum() / mass.diagonal().sum()
        inverse = splu(stiffness - shift * mass, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.0)
        solve = LinearOperator(stiffness.shape, inverse.solve)
        values = eigsh(stiffness, count, mass, sigma=shift, OPinv=solve, ncv=6 * count, return_eigenvectors=False)
        return np.sqrt(np.clip(np.sort(values), 0.0, None)) / 2 / np.pi


def von_mises(stress):
    deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * (deviator**2).sum((-2, -1)))


def quantity(value, unit):
    return {"value": float(value), "unit": unit}


def vector(values, unit):
    return {axis: quantity(value, unit) for axis, value in zip(AXES, values)}


def largest(values, places, unit):
    return {**quantity(values.max(), unit), "at": vector(places[values.argmax()], "m")}


def not_claimed(why):
    print(why)
    sys.exit(3)


def statics(solid):
    u, loads, reactions, of_sets = solid.statics()
    mesh, volumes = solid.mesh, solid.volumes
    f, strain, s = solid.stress(u)
    cauchy = f @ s @ np.swapaxes(f, 2, 3) / np.linalg.det(f)[..., None, None]
    of_element = volumes.sum(1)
    mean = np.einsum("ep,epij->eij", volumes, cauchy) / of_element[:, None, None]
    # At nodes: the linear field through the points of an element, weighted by the volumes of the elements around.
    shares = np.ones((4, 1))
    if mesh.kind == "tetra10":
        corners = np.eye(4)
        at = np.vstack([corners, [(corners[i] + corners[j]) / 2 for i, j in EDGES]])
        shares = at @ np.linalg.inv(solid.rule[0])
    of_nodes = np.einsum("np,epij->enij", shares, cauchy) * of_element[:, None, None, None]
    share, at_nodes = np.zeros(len(mesh.nodes)), np.zeros((len(mesh.nodes), 3, 3))
    np.add.at(share, mesh.elements, of_element[:, None])
    np.add.at(at_nodes, mesh.elements, of_nodes)
    at_nodes /= share[:, None, None]
    probes = {}
    for probe in solid.scene.get("probe", []):
        nodes = mesh.sets[probe["set"]]
        probes[probe.get("name", probe["set"])] = {**vector(u[nodes].mean(0), "m"), "nodes": len(nodes)}
    length = np.linalg.norm(u, axis=1)
    mass = solid.density * of_element.sum()
    held = {name: {axis: quantity(reactions[own].sum(), "N") for axis, own in axes.items()} for name, axes in of_sets.items()}
    total = [sum(reactions[own].sum() for axes in of_sets.values() for a, own in axes.items() if a == axis) for axis in AXES]
    summary = {
        "kind": "static solution of a solid",
        "mass": {"of_nodes": quantity(mass, "kg"), "of_volume": quantity(mass, "kg")},
        "loads": vector(loads.sum(0), "N"),
        "reactions": vector(total, "N"),
        "supports": held,
        "probes": probes,
        "largest": {
            "displacement": largest(length, mesh.nodes, "m"),
            "von_mises_of_elements": largest(von_mises(mean), mesh.nodes[mesh.elements[:, :4]].mean(1), "Pa"),
            "von_mises_of_nodes": largest(von_mises(at_nodes), mesh.nodes, "Pa"),
        },
        "strain_energy": quantity((volumes * (strain * s).sum((2, 3))).sum() / 2, "J"),
    }
    row = {"largest_displacement [m]": length.max()}
    row |= {f"{name}_{axis} [m]": probe[axis]["value"] for name, probe in probes.items() for axis in AXES}
    row |= {f"reaction_{name}_{axis} [N]": of["value"] for name, axes in held.items() for axis, of in axes.items()}
    return summary, row


def modes(solid, count):
    mass = quantity(solid.density * solid.volumes.sum(), "kg")
    listed = [{"mode": i + 1, "frequency": quantity(f, "Hz")} for i, f in enumerate(solid.modes(count))]
    return {"kind": "natural modes of a solid", "mass": {"of_nodes": mass, "of_volume": mass}, "modes": listed}


def main():
    kind, resolved, out = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    scene = json.loads(resolved.read_text()) if resolved.suffix == ".json" else {}
    if kind not in ("statics", "modes") or "youngs_modulus" not in scene.get("solid", {}).get("material", {}):
        not_claimed("equilibria and modes of elastic solids only")
    solid = Solid(scene, resolved.parent)
    out.mkdir(parents=True, exist_ok=True)
    if kind == "modes":
        summary = modes(solid, scene["modes"]["count"])
    else:
        summary, row = statics(solid)
        with open(out / "series.csv", "w", newline="") as file:
            csv.writer(file).writerows([row.keys(), row.values()])
    (out / "summary.json").write_text(json.dumps(summary))


if __name__ == "__main__":
    main()
