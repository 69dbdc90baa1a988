#include "ui/report/print/pdf_tags.h"

#include <fmt/core.h>

#define POINTERHOLDER_TRANSITION \
  4  // qpdf 11 asks which of its pointers are meant: those of the standard library

#include <memory>
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFPageDocumentHelper.hh>
#include <qpdf/QPDFPageObjectHelper.hh>
#include <qpdf/QPDFWriter.hh>
#include <set>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::report {
namespace {

/// Encloses what is painted outside all tags as an artifact: reading programs leave it out.
class Artifacts : public QPDFObjectHandle::TokenFilter {
 public:
  void handleToken(const QPDFTokenizer::Token& token) override {
    if (token.getType() != QPDFTokenizer::tt_word) {
      waiting_ += token.getRawValue();  // an operand, or white space
      return;
    }
    const std::string op = token.getValue();
    static const std::set<std::string> k_begins{"BT", "m", "re", "Do", "sh", "BI"},
        k_ends{"ET", "S", "s", "f", "F", "f*", "B", "B*", "b", "b*", "n", "Do", "sh", "EI"};
    if (op == "BDC" || op == "BMC") ++depth_;
    const bool begins = depth_ == 0 && !open_ && k_begins.contains(op);
    if (begins) write("/Artifact BMC\n");
    open_ = open_ || begins;
    write(waiting_ + op);
    waiting_.clear();
    if (op == "EMC") --depth_;
    if (open_ && k_ends.contains(op)) {
      write("\nEMC");
      open_ = false;
    }
  }
  void handleEOF() override { write(waiting_); }

 private:
  std::string waiting_;
  int depth_ = 0;
  bool open_ = false;
};

class Structure {
 public:
  explicit Structure(const std::vector<std::string>& pictures) : pictures_(pictures) {}

  void complete(QPDFObjectHandle element) {
    if (!element.isDictionary()) return;
    QPDFObjectHandle kind = element.getKey("/S");
    if (kind.isName() && kind.getName() == "/Figure") {
      const std::string words = next_ < pictures_.size() ? pictures_[next_] : "";
      element.replaceKey("/Alt", QPDFObjectHandle::newUnicodeString(words));
      ++next_;
    }
    if (kind.isName() && kind.getName() == "/TH")
      element.replaceKey("/A", QPDFObjectHandle::parse("<< /O /Table /Scope /Column >>"));
    QPDFObjectHandle inside = element.getKey("/K");
    if (inside.isArray())
      for (int i = 0; i < inside.getArrayNItems(); ++i) complete(inside.getArrayItem(i));
    else
      complete(inside);
  }

 private:
  const std::vector<std::string>& pictures_;
  std::size_t next_ = 0;
};

std::string metadata(const Document& d) {
  return fmt::format(
      "<?xpacket begin='\ufeff' id='W5M0MpCehiHzreSzNTczkc9d'?>\n<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF "
      "xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description rdf:about='' xmlns:dc='http://purl.org/dc/elements/1.1/'>"
      "<dc:title><rdf:Alt><rdf:li xml:lang='x-default'>{}</rdf:li></rdf:Alt></dc:title>"
      "<dc:language><rdf:Bag><rdf:li>{}</rdf:li></rdf:Bag></dc:language></rdf:Description></rdf:RDF></x:xmpmeta>\n"
      "<?xpacket end='r'?>",
      xml_text(one_line(d.title)), d.language);
}

}  // namespace

std::string complete_tags(const std::string& pdf, const Document& document,
                          const std::vector<std::string>& pictures) {
  try {
    QPDF file;
    file.setSuppressWarnings(true);
    file.processMemoryFile("report.pdf", pdf.data(), pdf.size());
    QPDFObjectHandle root = file.getRoot();
    root.replaceKey("/Lang", QPDFObjectHandle::newUnicodeString(document.language));
    root.replaceKey("/ViewerPreferences", QPDFObjectHandle::parse("<< /DisplayDocTitle true >>"));
    QPDFObjectHandle xmp = QPDFObjectHandle::newStream(&file, metadata(document));
    xmp.getDict().replaceKey("/Type", QPDFObjectHandle::newName("/Metadata"));
    xmp.getDict().replaceKey("/Subtype", QPDFObjectHandle::newName("/XML"));
    root.replaceKey("/Metadata", file.makeIndirectObject(xmp));
    Structure structure(pictures);
    structure.complete(root.getKey("/StructTreeRoot"));
    for (auto& page : QPDFPageDocumentHelper(file).getAllPages()) {
      page.getObjectHandle().replaceKey("/Tabs", QPDFObjectHandle::newName("/S"));
      page.addContentTokenFilter(std::make_shared<Artifacts>());
    }
    QPDFWriter out(file);
    out.setOutputMemory();
    out.setDeterministicID(true);
    out.setObjectStreamMode(qpdf_o_disable);
    out.write();
    const std::shared_ptr<Buffer> bytes = out.getBufferSharedPointer();
    return {reinterpret_cast<const char*>(bytes->getBuffer()), bytes->getSize()};
  } catch (const QPDFExc& e) {
    throw Error(msg("report"), msg("the PDF cannot be tagged: {}", one_line(e.what())),
                msg("write the report as .html"));
  }
}

}  // namespace cavum::report
