#!/usr/bin/env python3
"""Clauses of PDF/UA-1 (ISO 14289-1) that qpdf and poppler let a program see, held by reports in English and German.

pdf_clauses.py CAVUM SOURCE_DIR: sits an exam, writes its reports and checks them. pdf_clauses.py FILE.pdf: checks one file. What needs a person (whether
the order is sensible, whether a text says what a picture shows) is not here, and neither is what veraPDF checks beside this.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

STANDARD = set("Document Part Art Sect Div BlockQuote Caption TOC TOCI Index NonStruct Private P H H1 H2 H3 H4 H5 H6 L LI Lbl LBody Table TR TH TD THead "
               "TBody TFoot Span Quote Note Reference BibEntry Code Link Annot Figure Formula Form".split())
PAINTS = set("Tj TJ ' \" S s f F f* B B* b b* Do sh EI".split())


def run(*command):
    return subprocess.run(command, capture_output=True, check=False)


class Pdf:
    def __init__(self, path):
        self.path = path
        self.objects = json.loads(run("qpdf", "--json", path).stdout)
        self.objects = self.objects["qpdf"][1] if "qpdf" in self.objects else self.objects["objects"]
        self.trailer = self.get("trailer")
        self.root = self.get(self.trailer["/Root"])

    def get(self, reference):
        if not isinstance(reference, str) or not (reference == "trailer" or re.fullmatch(r"\d+ \d+ R", reference)):
            return reference
        found = self.objects.get("obj:" + reference, self.objects.get(reference))
        if isinstance(found, dict) and "value" in found:
            return found["value"]
        return found["stream"]["dict"] if isinstance(found, dict) and "stream" in found else found

    def children(self, element):
        kids = self.get(element.get("/K", []))
        return [k for k in map(self.get, kids if isinstance(kids, list) else [kids]) if isinstance(k, dict)]

    def elements(self, element=None):
        element = self.get(self.root["/StructTreeRoot"]) if element is None else element
        for child in self.children(element):
            if "/S" in child:
                yield child
            yield from self.elements(child)

    def stream(self, reference):
        return run("qpdf", f"--show-object={reference.split()[0]}", "--filtered-stream-data", self.path).stdout.decode("latin1")

    def pages(self):
        return [o for o in map(self.get, (k.removeprefix("obj:") for k in self.objects)) if isinstance(o, dict) and o.get("/Type") == "/Page"]


def loose_paint(content):
    """Painting operators that stand in no marked content."""
    content = re.sub(r"\((?:\\.|[^\\()])*\)", "()", content)
    depth = loose = 0
    for token in re.findall(r"<<|>>|<[0-9A-Fa-f\s]*>|[^\s<>\[\]()]+", content):
        depth += (token in ("BDC", "BMC")) - (token == "EMC")
        loose += token in PAINTS and depth == 0
    return loose


def clauses(path):
    """(clause, what, holds, detail) of each."""
    pdf = Pdf(path)
    elements = list(pdf.elements())
    kind = lambda e: e["/S"][1:]
    of = lambda k: [e for e in elements if kind(e) == k]
    cells = lambda table: [len(pdf.children(e)) for e in pdf.elements(table) if kind(e) == "TR"]
    heads = [int(kind(e)[1]) for e in elements if re.fullmatch("H[1-6]", kind(e))]
    def has_scope(head):
        attributes = pdf.get(head.get("/A", []))
        return any("/Scope" in (pdf.get(a) or {}) for a in (attributes if isinstance(attributes, list) else [attributes]))
    marked = pdf.get(pdf.root.get("/MarkInfo", {}))
    xmp = pdf.stream(pdf.root["/Metadata"]) if "/Metadata" in pdf.root else ""
    fonts = [line.split() for line in run("pdffonts", path).stdout.decode().splitlines()[2:]]
    contents = [c for p in pdf.pages() for c in (p["/Contents"] if isinstance(p["/Contents"], list) else [p["/Contents"]])]
    loose = sum(loose_paint(pdf.stream(c)) for c in contents)
    annotated = [p for p in pdf.pages() if pdf.get(p.get("/Annots", []))]
    yield "7.1", "it says that it is tagged, with nothing suspect", marked.get("/Marked") is True and not marked.get("/Suspects"), marked
    yield "7.1", "a title in its metadata, and shown", "<dc:title>" in xmp and pdf.get(pdf.root["/ViewerPreferences"]).get("/DisplayDocTitle") is True, xmp
    yield "7.1", "all that is painted is tagged or an artifact", loose == 0, f"{loose} operators are neither"
    yield "7.1", "standard types alone", {kind(e) for e in elements} <= STANDARD, {kind(e) for e in elements} - STANDARD
    yield "7.2", "a language", bool(pdf.root.get("/Lang")), pdf.root.get("/Lang")
    yield "7.3", "words for each picture", all("/Alt" in e for e in of("Figure")) and bool(of("Figure")), len(of("Figure"))
    yield "7.4", "headings from the first level on, none left out", heads[:1] == [1] and all(b <= a + 1 for a, b in zip(heads, heads[1:])), heads
    yield "7.5", "heads of tables say what they are of", all(map(has_scope, of("TH"))) and bool(of("TH")), len(of("TH"))
    yield "7.5", "rows of a table are equally long", all(len(set(cells(t))) == 1 for t in of("Table")), list(map(cells, of("Table")))
    yield "7.16", "no encryption", "/Encrypt" not in pdf.trailer, ""
    yield "7.18.3", "what is annotated is gone through in order of structure", all(p.get("/Tabs") == "/S" for p in annotated), len(annotated)
    yield "7.20", "pages know their place in the structure", all("/StructParents" in p for p in pdf.pages()), len(pdf.pages())
    yield "7.21.4", "fonts are in it", all(f[-5] == "yes" for f in fonts) and bool(fonts), fonts
    yield "7.21.7", "letters of fonts have their Unicode", all(f[-3] == "yes" for f in fonts), fonts


def check(path):
    failed = 0
    for clause, what, holds, detail in clauses(path):
        if not holds:
            failed += 1
            print(f"{path}: {clause}: not held: {what}: {detail}")
    return failed


def main():
    if len(sys.argv) == 2:
        return check(sys.argv[1])
    cavum, source = sys.argv[1:]
    failed = files = 0
    with tempfile.TemporaryDirectory() as folder:
        os.environ["CAVUM_HOME"] = folder
        at = lambda name: os.path.join(folder, name)
        subprocess.run([cavum, "exam", source + "/data/scenarios/slot.toml", "--candidate", "A17", "--operator", "novice", "--quiet", "--out", at("s.cavum")], check=True)
        for language in ("en", "de"):
            for reader in ("student", "instructor"):
                out = at(f"{reader}-{language}.pdf")
                subprocess.run([cavum, "--language", language, "report", at("s.cavum"), "--for", reader, "--no-replay", "--out", out], check=True)
                failed += check(out)
                files += 1
    print(f"{files} reports, {failed} clauses not held")
    return failed


if __name__ == "__main__":
    sys.exit(min(main(), 1))
