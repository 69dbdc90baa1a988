"""Hostile input to the other verbs: scenarios, rubrics, teeth, volumes, meshes, measured tables, motions."""
import os
import re
import struct

from kinds import ACCEPTED, FOUND, SURVIVES, attack


def scenario(s):
    return open(s.p("quick.toml"), encoding="utf-8").read()


@attack("input", ACCEPTED, "an untouched scenario has no mistakes")
def control_scenario(s):
    """The cheap scenario."""
    return s.run("scenario", "check", "--no-trial", s.p("quick.toml"))


@attack("input", SURVIVES, "scenario check names every mistake")
def scenarios_nested(s):
    """Arrays, tables, keys, conditions and quotes nested or repeated 100000 times."""
    good = scenario(s)
    last = None
    for text in ("a = " + "[" * 100000, "a = " + "[" * 100000 + "]" * 100000, "[" + "a." * 100000 + "b]\n", "a = " + "{a=" * 50000 + "1" + "}" * 50000,
                 re.sub(r'complete_when = .*', 'complete_when = "' + "(" * 100000 + '"', good), re.sub(r'complete_when = .*', 'complete_when = "' + "!" * 100000 + 'pedal"', good),
                 re.sub(r'complete_when = .*', 'complete_when = "' + "-" * 100000 + '1 > 0"', good), re.sub(r'complete_when = .*', 'complete_when = "' + "pedal < 1 && " * 50000 + 'pedal < 1"', good),
                 "\n".join(f"[t{i}]" for i in range(100000)), good + "\n[[steps]]\nid = \"x\"\ninstruction = \"y\"\ncomplete_when = \"1 > 0\"\n" * 5000, 'a = """' + "x" * 5_000_000):
        last = s.run("scenario", "check", s.text("m.toml", text))
        s.must(last.rc != 0, f"no mistake in {text[:40]!r}")
    return last


@attack("input", SURVIVES, "scenario check names every mistake")
def scenarios_with_odd_numbers(s):
    """nan, inf, 1e308, negative and huge numbers in every number of the scenario, one at a time."""
    good = scenario(s)
    last = None
    for key in ("max_rpm", "time_limit_s", "sides_mm", "radius_mm", "depth_mm", "pass_percent", "borderline_percent", "full", "zero", "points", "critical_above"):
        for value in ("nan", "inf", "-1e308", "9223372036854775807"):
            text = re.sub(rf"\b{key} = [\d.]+", f"{key} = {value}", good, count=1)
            last = s.run("scenario", "check", "--no-trial", s.text("m.toml", text))
            if value == "nan":
                s.must(last.rc != 0, f"{key} = nan is no mistake")
    return last


@attack("input", FOUND, "a scenario names files")
def scenario_files(s):
    """The tooth and the burs of a scenario are /dev/zero, /etc/passwd, a pipe, a folder, a path out of the data."""
    good = scenario(s)
    os.mkfifo(s.p("pipe"))
    last = None
    for name in ("/dev/zero", "/etc/passwd", "../../../../../../etc/passwd", "pipe", ".", "", "block.cvt\\u0000x", "/proc/self/mem", "\\u001b[2J"):
        last = s.run("scenario", "check", s.text("m.toml", good.replace('"block.cvt"', f'"{name}"')))
        s.must(last.rc != 0, f"tooth {name!r} is taken")
        s.must("root:x:" not in last.out, "the content of a file is shown")
        last = s.run("scenario", "check", s.text("m.toml", good.replace('"round-1.0"', f'"{name}"')))
        s.must(last.rc != 0, f"bur {name!r} is taken")
    os.symlink("/dev/zero", s.p("z.toml"))
    s.must(s.run("scenario", "check", s.p("z.toml")).rc != 0, "an endless scenario is taken")
    return s.run("scenario", "check", s.p("pipe"))


@attack("input", SURVIVES, "grade by another rubric")
def rubrics_odd(s):
    """Rubrics whose points are nan, negative, 1e308 each, none; 20000 criteria; the same id twice; a hostile title."""
    body = scenario(s).split("[rubric]")[1].replace("[[rubric.criteria]]", "[[criteria]]")
    last = None
    for text in (body.replace("points = 60", "points = nan"), body.replace("points = 60", "points = -60"), re.sub(r"points = \d+", "points = 1e308", body), body.replace("full = 90", "full = 60"),
                 body.replace('id = "damage"', 'id = "removed"'), body + "".join(f'\n[[criteria]]\nid = "c{i}"\ntitle = "t"\nmetric = "target_removed_percent"\nfull = 90\nzero = 60\npoints = 1\n' for i in range(5000)),
                 body.replace("Cavity complete", "\\u001b[2J\\u202e"), body.replace("target_removed_percent", "x" * 100000), ""):
        last = s.run("grade", s.p("anna.cavum"), "--rubric", s.text("r.toml", text))
        s.must("nan" not in last.out or last.rc != 0, "points that are no number")
    return last


def stl(count, body=b""):
    return b"\0" * 80 + struct.pack("<I", count) + body


@attack("input", FOUND, "meshes are input")
def meshes_lie(s):
    """STL, PLY, OBJ and OFF that claim 2^32 - 1 triangles, name points that are not there, hold nan, or nothing."""
    nan = struct.pack("<12f", *([float("nan")] * 12)) + b"\0\0"
    cases = {"a.stl": stl(2**32 - 1), "b.stl": stl(4, nan * 4), "c.stl": b"solid x\n" + b"facet normal 0 0 0\nouter loop\n" * 1000, "d.stl": stl(0),
             "e.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\nelement face 4294967295\nproperty list uint int vertex_indices\nend_header\n",
             "f.ply": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99999999\n",
             "g.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999999\nf -9 -8 -7\n", "h.off": b"OFF\n4294967295 4294967295 0\n", "i.off": b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2147483647 0 1 2\n",
             "j.obj": b"v 1e999 nan 0\n" * 1000 + b"f 1 2 3\n", "k.ply": b"ply\n" + b"element x 1\n" * 100000, "l.stl": b"", "m.obj": b"f " + b"1 " * 2_000_000}
    last = None
    for name, data in cases.items():
        s.text(name, data, "wb")
        last = s.run("tooth", "import", "--enamel", s.p(name), "--dentin", s.p(name), "--pulp", s.p(name), "--out", s.p("t.cvt"))
        s.must(last.rc != 0, name + " is imported")
    return last


@attack("input", FOUND, "volumes are input")
def volumes_lie(s):
    """MetaImage, NRRD, NIfTI, TIFF and DICOM headers with sizes of 2^31, below nothing, data elsewhere, loops, rests."""
    nifti = bytearray(352)
    struct.pack_into("<i", nifti, 0, 348)
    struct.pack_into("<8h", nifti, 40, 3, 32767, 32767, 32767, 1, 1, 1, 1)
    struct.pack_into("<hh", nifti, 70, 4, 16)
    struct.pack_into("<8f", nifti, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", nifti, 108, 352)
    nifti[344:348] = b"n+1\0"
    negative = bytearray(nifti)
    struct.pack_into("<8h", negative, 40, 3, -1, -5, 2, 1, 1, 1, 1)
    far = bytearray(nifti)
    struct.pack_into("<8h", far, 40, 3, 2, 2, 2, 1, 1, 1, 1)
    struct.pack_into("<f", far, 108, float("inf"))
    tiff = b"II*\0\x08\0\0\0" + struct.pack("<H", 1) + struct.pack("<HHII", 256, 4, 1, 2**31 - 1) + struct.pack("<I", 8)
    cases = {"a.mhd": b"ObjectType = Image\nNDims = 3\nDimSize = 2147483647 2147483647 2147483647\nElementType = MET_SHORT\nElementDataFile = LOCAL\n",
             "b.mhd": b"ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = /etc/passwd\n", "c.mhd": b"ObjectType = Image\nNDims = 3\nDimSize = -2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n12345678",
             "d.mhd": b"ObjectType = Image\nNDims = 3\nDimSize = 40 40 40\nElementType = MET_UCHAR\nElementDataFile = /dev/zero\n", "e.mhd": b"NDims = 3\nElementDataFile = e.mhd\nDimSize = 2 2 2\nElementType = MET_UCHAR\n",
             "f.nrrd": b"NRRD0004\ntype: short\ndimension: 3\nsizes: 4294967296 4294967296 4294967296\nencoding: raw\n\n", "g.nrrd": b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: gzip\nspacings: nan 1 1\n\n\x1f\x8b\x08",
             "h.nrrd": b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: /dev/zero\n\n", "i.nrrd": b"NRRD0004\ntype: uchar\ndimension: 999999999\nsizes:" + b" 1" * 100000 + b"\n\n",
             "j.nii": bytes(nifti), "k.nii": bytes(negative), "l.nii": bytes(far), "m.tif": tiff, "n.tif": b"II*\0\xff\xff\xff\xff", "o.nii": b"", "p.nrrd": b"NRRD0004\n" + b"# x\n" * 1_000_000}
    last = None
    for name, data in cases.items():
        s.text(name, data, "wb")
        last = s.run("tooth", "import", s.p(name), "--out", s.p("t.cvt"))
        s.must(last.rc != 0, name + " is imported")
        s.must("root:x" not in last.out, "a file's content is shown")
    os.makedirs(s.p("dicom"))
    s.text("dicom/1.dcm", bytes(128) + b"DICM" + b"\x02\0\0\0OB\0\0\xff\xff\xff\xff" * 3000, "wb")
    os.mkfifo(s.p("dicom/2.dcm"))
    os.symlink("/dev/zero", s.p("dicom/3.dcm"))
    last = s.run("tooth", "import", s.p("dicom"), "--out", s.p("t.cvt"))
    os.mkfifo(s.p("pipe.mhd"))
    s.must(last.rc != 0, "a folder of rubbish is imported")
    return s.run("tooth", "import", s.p("pipe.mhd"), "--out", s.p("t.cvt"))


@attack("input", FOUND, "options are input")
def import_options(s):
    """Options with nan, nothing, minus and huge numbers."""
    s.text("v.nrrd", b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nspacings: 0.1 0.1 0.1\n\n" + bytes(range(256)) * 2, "wb")
    last = None
    for more in (["--leaf-mm", "0"], ["--leaf-mm", "nan"], ["--leaf-mm", "1e-9"], ["--leaf-mm", "-1"], ["--spacing-mm", "nan"], ["--spacing-mm", "1e9"], ["--spacing-mm", ","], ["--occlusal-axis", "0,0,0"],
                 ["--occlusal-axis", "nan,0,1"], ["--map", "1=enamel,1=dentin"], ["--map", "=" * 10000], ["--periodontium-mm", "1e9"], ["--rotate-deg", "inf"]):
        last = s.run("tooth", "import", s.p("v.nrrd"), "--dentin-threshold", "50", "--enamel-threshold", "150", "--out", s.p("t.cvt"), *more)
        if os.path.exists(s.p("t.cvt")):
            s.must(False, f"{more} is taken")
            os.remove(s.p("t.cvt"))
    return last


@attack("input", SURVIVES, "tables are input")
def measured_tables(s):
    """explain: tables with nan, nothing, huge numbers, one line of 20 MB, a million columns, hostile names; a rig that is none."""
    head = "t_s,x_mm,f_n\n"
    last = None
    for text in ("", head, head + "nan,nan,nan\n" * 1000, head + "1e999,1,1\n" * 10, head + "0,0,0\n" * 10, "," * 1_000_000, "x" * 20_000_000, head + "\0" * 1000, "\u001b[2J,\u202e\n1,2\n", "f_n,k_n_per_mm,v_mm_s\n1e308,1e-308,0\n-1,0,nan\n"):
        s.text("m.csv", text)
        s.text("rig.toml", "a = " + "[" * 50000)
        last = s.run("explain", s.p("m.csv"), "--twins", "0")
    os.remove(s.p("rig.toml"))
    os.mkfifo(s.p("pipe.csv"))
    s.run("explain", s.p("pipe.csv"), "--twins", "0")
    os.symlink("/dev/zero", s.p("zero.csv"))
    s.run("explain", s.p("zero.csv"), "--twins", "0")
    return s.run("explain", s.p("anna.cavum"), "--twins", "0")


@attack("input", SURVIVES, "motions are input")
def motions(s):
    """exam --motion: files of nothing, nan, huge numbers, jumps of a kilometre, a pipe, an endless device."""
    last = None
    for i, text in enumerate(("", "x\n", "t_s,x_mm,y_mm,z_mm\n0,nan,0,0\n", "t_s,x_mm,y_mm,z_mm,pedal\n" + "0,1e308,0,0,1\n" * 100, "x_mm,y_mm,z_mm,pedal,rpm\n0,0,0,1,1\n" * 5, "," * 100000, "\0" * 5000)):
        s.text("m.csv", text)
        last = s.run("exam", s.p("quick.toml"), "--candidate", "x", "--motion", s.p("m.csv"), "--out", s.p(f"m{i}.cavum"), "--quiet", home=s.p("seat1"))
    os.mkfifo(s.p("pipe.csv"))
    s.run("exam", s.p("quick.toml"), "--candidate", "x", "--motion", s.p("pipe.csv"), "--out", s.p("mp.cavum"), "--quiet", home=s.p("seat1"))
    os.symlink("/dev/zero", s.p("zero.csv"))
    return s.run("exam", s.p("quick.toml"), "--candidate", "x", "--motion", s.p("zero.csv"), "--out", s.p("mz.cavum"), "--quiet", home=s.p("seat1"))


@attack("input", FOUND, "an existing file is never replaced")
def out_is_there(s):
    """--out names a file, a link to one, a link to nothing, a folder: nothing is written over."""
    s.text("precious", "precious")
    os.symlink(s.p("precious"), s.p("link.cavum"))
    os.symlink(s.p("elsewhere"), s.p("dangling.cavum"))
    last = None
    for name in ("precious", "link.cavum", "dangling.cavum", "."):
        last = s.run("exam", s.p("quick.toml"), "--candidate", "x", "--operator", "expert", "--out", s.p(name), "--quiet", home=s.p("seat1"))
        s.must(last.rc != 0, f"{name} is written")
    for verb in (("export", "--format", "csv"), ("receipt", "--entry", "3"), ("checkpoint", "--since", "0")):
        s.must(s.ledger(*verb, "--out", s.p("link.cavum")).rc != 0, f"{verb[0]} writes over a link's file")
    s.ledger("export", "--format", "csv", "--out", s.p("link.cavum"), "--overwrite")
    s.must(open(s.p("precious")).read() == "precious", "a file behind a link was written over")
    s.must(not os.path.exists(s.p("elsewhere")), "a file was made behind a link")
    return last
