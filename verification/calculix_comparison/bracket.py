"""Meshes a bracket with Gmsh and writes what CalculiX needs.

    pip install gmsh
    python bracket.py

An angle of two plates with a rib between them and a hole through the upright one; mm, N, MPa, t.
Writes for each order the mesh as .msh and, node for node, as .inp. Coordinates are rounded to 1e-7 mm
before either is written, so that both programs read the same numbers.
"""

import gmsh

LOAD = (1.5e-3, 3.5e-3, -2.5e-3)  # N on the loaded face, in all


def bracket(order, size, version):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 1)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.add("bracket")
    occ = gmsh.model.occ
    base = occ.addBox(0, 0, 0, 120, 16, 8)
    upright = occ.addBox(0, 0, 0, 8, 16, 110)
    hole = occ.addCylinder(-1, 8, 94, 10, 0, 0, 4.5)
    corners = [occ.addPoint(x, 5, z) for x, z in [(8, 8), (32, 8), (8, 32)]]
    sides = [occ.addLine(corners[i], corners[(i + 1) % 3]) for i in range(3)]
    rib = occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(sides)]))], 0, 6, 0)
    rib = [entity for entity in rib if entity[0] == 3]
    body, _ = occ.fuse([(3, base)], [(3, upright)] + rib)
    body, _ = occ.cut(body, [(3, hole)])
    occ.synchronize()

    def face(axis, value):
        found = []
        for _, tag in gmsh.model.getEntities(2):
            box = gmsh.model.getBoundingBox(2, tag)
            if abs(box[axis] - value) < 1e-3 and abs(box[axis + 3] - value) < 1e-3:
                found.append(tag)
        assert found, (axis, value)
        return found

    gmsh.model.addPhysicalGroup(3, [tag for _, tag in body], name="bracket")
    faces = {"held": face(0, 120), "loaded": face(2, 110)}
    for name, tags in faces.items():
        gmsh.model.addPhysicalGroup(2, tags, name=name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.6 * size)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 10)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    gmsh.model.mesh.renumberNodes()
    gmsh.model.mesh.renumberElements()

    tags, places, _ = gmsh.model.mesh.getNodes()
    nodes = {}
    for i, tag in enumerate(tags):
        nodes[tag] = [round(x, 7) + 0.0 for x in places[3 * i : 3 * i + 3]]
        gmsh.model.mesh.setNode(tag, nodes[tag], [])
    kind = {1: "C3D4", 2: "C3D10"}[order]
    name = f"bracket_{kind.lower()}"
    gmsh.write(f"{name}.msh")

    element_type, per_face = {1: (4, 3), 2: (11, 6)}[order]
    _, members = gmsh.model.mesh.getElementsByType(element_type)
    per_element = {1: 4, 2: 10}[order]
    with open(f"{name}_mesh.inp", "w") as out:
        out.write("*NODE, NSET=ALL\n")
        for tag in sorted(nodes):
            out.write(f"{tag}," + ",".join(f"{x:.10g}" for x in nodes[tag]) + "\n")
        out.write(f"*ELEMENT, TYPE={kind}, ELSET=BRACKET\n")
        for i in range(len(members) // per_element):
            of = list(members[i * per_element : (i + 1) * per_element])
            if order == 2:
                of[8], of[9] = of[9], of[8]  # Gmsh's last two edges are the other way round
            out.write(f"{i + 1}," + ",".join(map(str, of)) + "\n")
        held = set()
        for tag in faces["held"]:
            _, _, (of,) = gmsh.model.mesh.getElements(2, tag)
            held.update(int(n) for n in of)
        out.write("*NSET, NSET=HELD\n")
        for tag in sorted(held):
            out.write(f"{tag}\n")

    # A third of each triangle's load to each of its nodes: the corners of linear triangles, the
    # middles of flat quadratic ones.
    loads, whole = {}, 0.0
    for tag in faces["loaded"]:
        _, _, (of,) = gmsh.model.mesh.getElements(2, tag)
        for i in range(0, len(of), per_face):
            triangle = of[i : i + per_face]
            (ax, ay, _), (bx, by, _), (cx, cy, _) = (nodes[n] for n in triangle[:3])
            area = 0.5 * abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
            whole += area
            for n in triangle[:3] if order == 1 else triangle[3:]:
                loads[n] = loads.get(n, 0.0) + area / 3
    with open(f"{name}_loads.inp", "w") as out:
        for n in sorted(loads):
            for axis in range(3):
                out.write(f"{n},{axis + 1},{LOAD[axis] * loads[n] / whole:.12e}\n")
    print(name, len(nodes), "nodes,", len(members) // per_element, "elements")
    gmsh.finalize()


bracket(1, 2.8, 4.1)
bracket(2, 5.5, 2.2)
