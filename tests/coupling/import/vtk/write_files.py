# Files of Python's VTK for import_vtk_test.cc: write_files.py FOLDER.
import vtk, sys
from vtk.util import numpy_support as ns
import numpy as np
out=sys.argv[1]+'/'
n=4
pts=np.array([[0,0,.004995],[0,0,.014985],[0,0,.024975],[0,0,.034965]])
ids=np.array([11,12,13,15],dtype=np.int64)
def poly(points):
    pd=vtk.vtkPolyData(); p=vtk.vtkPoints(); p.SetDataTypeToDouble()
    for x in points: p.InsertNextPoint(*x)
    pd.SetPoints(p); return pd
def arr(name,a):
    v=ns.numpy_to_vtk(np.ascontiguousarray(a),deep=1); v.SetName(name); return v
g=poly(pts)
for nme,a in (('id',ids),('radius',np.full(n,.005)),('velocity',np.zeros((n,3)))): g.GetPointData().AddArray(arr(nme,a))
verts=vtk.vtkCellArray()
for i in range(n): verts.InsertNextCell(1); verts.InsertCellPoint(i)
g.SetVerts(verts)
lines=vtk.vtkCellArray()
for i in range(3): lines.InsertNextCell(2); lines.InsertCellPoint(i); lines.InsertCellPoint(i+1)
F=np.array([[0,0,-3.],[0,0,-2.],[0,0,-1.]])
c=poly(pts); c.SetLines(lines)
for nme,a in (('force',F),('id1',ids[:3]),('id2',ids[1:])): c.GetCellData().AddArray(arr(nme,a))
b=poly(pts); b.SetLines(lines)
for nme,a in (('id',ids),('radius',np.full(n,.005))): b.GetPointData().AddArray(arr(nme,a))
b.GetCellData().AddArray(arr('force',F))
def wx(pd,name,mode,enc,comp,ht=None):
    w=vtk.vtkXMLPolyDataWriter(); w.SetInputData(pd); w.SetFileName(out+name)
    {'ascii':w.SetDataModeToAscii,'binary':w.SetDataModeToBinary,'appended':w.SetDataModeToAppended}[mode]()
    w.SetEncodeAppendedData(enc)
    w.SetCompressorTypeToZLib() if comp else w.SetCompressorTypeToNone()
    w.SetHeaderTypeToUInt64() if ht==64 else w.SetHeaderTypeToUInt32()
    w.Write()
for pd,nm in ((g,'g'),(c,'c'),(b,'b')):
    wx(pd,nm+'_ascii.vtp','ascii',0,0); wx(pd,nm+'_bin.vtp','binary',0,0); wx(pd,nm+'_binz.vtp','binary',0,1)
    wx(pd,nm+'_raw.vtp','appended',0,0); wx(pd,nm+'_rawz.vtp','appended',0,1); wx(pd,nm+'_base.vtp','appended',1,0); wx(pd,nm+'_basez.vtp','appended',1,1,64)
    for ft in ('a','b'):
        for ver in (42,51):
            w=vtk.vtkPolyDataWriter(); w.SetInputData(pd); w.SetFileName(out+f'{nm}_{ft}{ver}.vtk'); w.SetFileVersion(ver)
            (w.SetFileTypeToASCII if ft=='a' else w.SetFileTypeToBinary)(); w.Write()
