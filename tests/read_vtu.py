"""Reads .vtu files with VTK's own reader, which is ParaView's, and prints what it found as JSON.

Usage: read_vtu.py FILE...
"""
import json
import sys

import vtk

found = []
for path in sys.argv[1:]:
    reader = vtk.vtkXMLUnstructuredGridReader()
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append("error"))
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    # Every cell cut into straight tetrahedra, and their volumes.
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volume = sizes.GetOutput().GetCellData().GetArray("Volume")
    middles = 0.0
    for cell in range(grid.GetNumberOfCells()):
        points = grid.GetCell(cell).GetPoints()
        if points.GetNumberOfPoints() == 10:
            for node, (a, b) in enumerate([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]):
                ends = [points.GetPoint(a), points.GetPoint(b)]
                middle = points.GetPoint(4 + node)
                gap = max(abs(m - (p + q) / 2) for m, p, q in zip(middle, *ends))
                middles = max(middles, gap)

    def arrays(data):
        return {
            data.GetArrayName(i): [
                data.GetArray(i).GetNumberOfComponents(),
                data.GetArray(i).GetNumberOfTuples(),
                [data.GetArray(i).GetRange(c)[1] for c in range(data.GetArray(i).GetNumberOfComponents())],
            ]
            for i in range(data.GetNumberOfArrays())
        }

    found.append(
        {
            "problems": problems,
            "points": grid.GetNumberOfPoints(),
            "cells": grid.GetNumberOfCells(),
            "type": grid.GetCellType(0),
            "bounds": grid.GetBounds(),
            "volume": sum(volume.GetValue(i) for i in range(grid.GetNumberOfCells())),
            "farthest_middle": middles,
            "point_data": arrays(grid.GetPointData()),
            "cell_data": arrays(grid.GetCellData()),
        }
    )
print(json.dumps(found))
