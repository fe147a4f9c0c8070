// Atom names and bond orders as in the wwPDB chemical component dictionary (CC0), written by hand as bond
// lists: '-' single,
// '=' double, ':' aromatic. Names of hydrogens follow PDB format 3; others are left to the distance rule.
#include "core/residue_templates.h"

#include <cstddef>
#include <string>
#include <unordered_map>

namespace meniscus {
namespace {

struct Source {
  std::string_view names;  ///< residue names that share the list, separated by spaces
  ResidueKind kind;
  std::string_view backbone;
  std::string_view bonds;
};

constexpr std::string_view kPeptide =
    "N-CA CA-C C=O C-OXT OXT-HXT N-H N-H1 N-H2 N-H3 CA-HA CA-HA2 CA-HA3 CA-CB";
constexpr std::string_view kSugarPhosphate =
    "P=OP1 P-OP2 P-OP3 P-O5' P=O1P P-O2P P-O3P O5'-C5' C5'-C4' C4'-O4' C4'-C3' C3'-O3' C3'-C2' C2'-O2' "
    "C2'-C1' "
    "C1'-O4' OP3-HOP3 OP2-HOP2 O5'-HO5' O3'-HO3' O2'-HO2' C5'-H5' C5'-H5'' C4'-H4' C3'-H3' C2'-H2' C2'-H2'' "
    "C1'-H1'";
constexpr ResidueKind kAmino = ResidueKind::aminoAcid;
constexpr ResidueKind kNucleo = ResidueKind::nucleotide;

constexpr Source kSources[] = {
    {"ALA", kAmino, kPeptide, "CB-HB1 CB-HB2 CB-HB3"},
    {"ARG", kAmino, kPeptide,
     "CB-CG CG-CD CD-NE NE-CZ CZ-NH1 CZ=NH2 CB-HB2 CB-HB3 CG-HG2 CG-HG3 CD-HD2 CD-HD3 NE-HE NH1-HH11 "
     "NH1-HH12 "
     "NH2-HH21 NH2-HH22"},
    {"ASN", kAmino, kPeptide, "CB-CG CG=OD1 CG-ND2 CB-HB2 CB-HB3 ND2-HD21 ND2-HD22"},
    {"ASP ASH", kAmino, kPeptide, "CB-CG CG=OD1 CG-OD2 OD2-HD2 CB-HB2 CB-HB3"},
    {"CYS CYX CYM", kAmino, kPeptide, "CB-SG SG-HG CB-HB2 CB-HB3"},
    {"GLN", kAmino, kPeptide, "CB-CG CG-CD CD=OE1 CD-NE2 CB-HB2 CB-HB3 CG-HG2 CG-HG3 NE2-HE21 NE2-HE22"},
    {"GLU GLH", kAmino, kPeptide, "CB-CG CG-CD CD=OE1 CD-OE2 OE2-HE2 CB-HB2 CB-HB3 CG-HG2 CG-HG3"},
    {"GLY", kAmino, kPeptide, ""},
    {"HIS HID HIE HIP HSD HSE HSP", kAmino, kPeptide,
     "CB-CG CG:ND1 CG:CD2 ND1:CE1 CD2:NE2 CE1:NE2 CB-HB2 CB-HB3 ND1-HD1 CD2-HD2 CE1-HE1 NE2-HE2"},
    {"ILE", kAmino, kPeptide,
     "CB-CG1 CB-CG2 CG1-CD1 CG1-CD CB-HB CG1-HG12 CG1-HG13 CG2-HG21 CG2-HG22 CG2-HG23 CD1-HD11 CD1-HD12 "
     "CD1-HD13"},
    {"LEU", kAmino, kPeptide,
     "CB-CG CG-CD1 CG-CD2 CB-HB2 CB-HB3 CG-HG CD1-HD11 CD1-HD12 CD1-HD13 CD2-HD21 CD2-HD22 CD2-HD23"},
    {"LYS LYN", kAmino, kPeptide,
     "CB-CG CG-CD CD-CE CE-NZ CB-HB2 CB-HB3 CG-HG2 CG-HG3 CD-HD2 CD-HD3 CE-HE2 CE-HE3 NZ-HZ1 NZ-HZ2 NZ-HZ3"},
    {"MET", kAmino, kPeptide, "CB-CG CG-SD SD-CE CB-HB2 CB-HB3 CG-HG2 CG-HG3 CE-HE1 CE-HE2 CE-HE3"},
    {"MSE", kAmino, kPeptide, "CB-CG CG-SE SE-CE CB-HB2 CB-HB3 CG-HG2 CG-HG3 CE-HE1 CE-HE2 CE-HE3"},
    {"PHE", kAmino, kPeptide,
     "CB-CG CG:CD1 CG:CD2 CD1:CE1 CD2:CE2 CE1:CZ CE2:CZ CB-HB2 CB-HB3 CD1-HD1 CD2-HD2 CE1-HE1 CE2-HE2 CZ-HZ"},
    {"PRO", kAmino, kPeptide, "CB-CG CG-CD CD-N CB-HB2 CB-HB3 CG-HG2 CG-HG3 CD-HD2 CD-HD3"},
    {"PYL", kAmino, "N-CA CA-C C=O C-OXT OXT-HXT N-H N-H2 CA-HA CA-CB",
     "CB-CG CG-CD CD-CE CE-NZ NZ-C2 C2=O2 C2-CA2 CA2-N2 CA2-CB2 N2=CE2 CE2-CD2 CD2-CG2 CG2-CB2 CB2-HB2"},
    {"SEC", kAmino, kPeptide, "CB-SE SE-HE CB-HB2 CB-HB3"},
    {"SER", kAmino, kPeptide, "CB-OG OG-HG CB-HB2 CB-HB3"},
    {"THR", kAmino, kPeptide, "CB-OG1 CB-CG2 OG1-HG1 CB-HB CG2-HG21 CG2-HG22 CG2-HG23"},
    {"TRP", kAmino, kPeptide,
     "CB-CG CG:CD1 CG:CD2 CD1:NE1 NE1:CE2 CE2:CD2 CD2:CE3 CE3:CZ3 CZ3:CH2 CH2:CZ2 CZ2:CE2 CB-HB2 CB-HB3 "
     "CD1-HD1 "
     "NE1-HE1 CE3-HE3 CZ2-HZ2 CZ3-HZ3 CH2-HH2"},
    {"TYR", kAmino, kPeptide,
     "CB-CG CG:CD1 CG:CD2 CD1:CE1 CD2:CE2 CE1:CZ CE2:CZ CZ-OH OH-HH CB-HB2 CB-HB3 CD1-HD1 CD2-HD2 CE1-HE1 "
     "CE2-HE2"},
    {"VAL", kAmino, kPeptide, "CB-CG1 CB-CG2 CB-HB CG1-HG11 CG1-HG12 CG1-HG13 CG2-HG21 CG2-HG22 CG2-HG23"},
    {"A DA ADE RA A5 A3 DA5 DA3", kNucleo, kSugarPhosphate,
     "C1'-N9 N9:C8 C8:N7 N7:C5 C5:C6 C6-N6 C6:N1 N1:C2 C2:N3 N3:C4 C4:C5 C4:N9 C8-H8 N6-H61 N6-H62 C2-H2"},
    {"G DG GUA RG G5 G3 DG5 DG3", kNucleo, kSugarPhosphate,
     "C1'-N9 N9:C8 C8:N7 N7:C5 C5-C6 C6=O6 C6-N1 N1-C2 C2-N2 C2=N3 N3-C4 C4:C5 C4:N9 C8-H8 N1-H1 N2-H21 "
     "N2-H22"},
    {"I DI", kNucleo, kSugarPhosphate,
     "C1'-N9 N9:C8 C8:N7 N7:C5 C5-C6 C6=O6 C6-N1 N1-C2 C2=N3 N3-C4 C4:C5 C4:N9 C8-H8 N1-H1 C2-H2"},
    {"C DC CYT RC C5 C3 DC5 DC3", kNucleo, kSugarPhosphate,
     "C1'-N1 N1-C2 C2=O2 C2-N3 N3=C4 C4-N4 C4-C5 C5=C6 C6-N1 N4-H41 N4-H42 C5-H5 C6-H6"},
    {"U DU URA RU U5 U3", kNucleo, kSugarPhosphate,
     "C1'-N1 N1-C2 C2=O2 C2-N3 N3-C4 C4=O4 C4-C5 C5=C6 C6-N1 N3-H3 C5-H5 C6-H6"},
    {"DT T THY DT5 DT3", kNucleo, kSugarPhosphate,
     "C1'-N1 N1-C2 C2=O2 C2-N3 N3-C4 C4=O4 C4-C5 C5-C7 C5-C5M C5=C6 C6-N1 N3-H3 C6-H6 C7-H71 C7-H72 C7-H73"},
};

/// Calls visit(word) for the words of a text separated by single blanks.
template <typename Visit>
void forEachWord(std::string_view text, Visit visit) {
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    if (blank != 0) visit(text.substr(0, blank));
    if (blank == std::string_view::npos) return;
    text.remove_prefix(blank + 1);
  }
}

std::uint8_t nameIndex(ResidueTemplate& residue, std::string_view name) {
  const AtomName wanted(name);
  for (std::size_t i = 0; i < residue.names.size(); ++i) {
    if (residue.names[i] == wanted) return static_cast<std::uint8_t>(i);
  }
  residue.names.push_back(wanted);
  return static_cast<std::uint8_t>(residue.names.size() - 1);
}

ResidueTemplate parse(const Source& source) {
  ResidueTemplate residue;
  residue.kind = source.kind;
  const auto addBond = [&residue](std::string_view bond) {
    const std::size_t sign = bond.find_first_of("-=:");
    const std::uint8_t order = bond[sign] == '-' ? 1 : bond[sign] == '=' ? 2 : 4;
    const std::uint8_t a = nameIndex(residue, bond.substr(0, sign));
    const std::uint8_t b = nameIndex(residue, bond.substr(sign + 1));
    residue.bonds.push_back({a, b, order});
  };
  forEachWord(source.backbone, addBond);
  forEachWord(source.bonds, addBond);
  return residue;
}

std::unordered_map<std::string_view, ResidueTemplate> parseAll() {
  std::unordered_map<std::string_view, ResidueTemplate> templates;
  for (const Source& source : kSources) {
    const ResidueTemplate residue = parse(source);
    forEachWord(source.names, [&](std::string_view name) { templates.emplace(name, residue); });
  }
  return templates;
}

}  // namespace

int ResidueTemplate::indexOf(const AtomName& name) const {
  AtomName wanted = name;
  for (char& c : wanted.text) {
    if (c == '*') c = '\'';
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == wanted) return static_cast<int>(i);
  }
  return -1;
}

const ResidueTemplate* findResidueTemplate(std::string_view residueName) {
  static const std::unordered_map<std::string_view, ResidueTemplate> templates = parseAll();
  const auto found = templates.find(residueName);
  return found == templates.end() ? nullptr : &found->second;
}

}  // namespace meniscus
