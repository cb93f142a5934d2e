#include "coupling/import/synonyms.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "coupling/import/table.h"

namespace grainfield::coupling {
namespace {

const std::map<std::string, Synonyms>& all_synonyms() {
  static const std::map<std::string, Synonyms> all{
      {"id",
       {{"particle", "particleid", "particlenumber", "grain", "grainid", "ball", "ballid", "body",
         "bodyid", "ids", "atomid", "pid", "particleidentifier"},
        {"number", "no", "index", "label", "name"}}},
      {"x",
       {{"xpos", "posx", "positionx", "position0", "centrex", "centerx", "coordx", "xcoord",
         "coordinatex", "coordinates0", "points0", "coord0", "pos0", "particlexcoordinate",
         "particlepositionx", "particlex"},
        {"xc", "cx", "x1"}}},
      {"y",
       {{"ypos", "posy", "positiony", "position1", "centrey", "centery", "coordy", "ycoord",
         "coordinatey", "coordinates1", "points1", "coord1", "pos1", "particleycoordinate",
         "particlepositiony", "particley"},
        {"yc", "cy", "x2"}}},
      {"z",
       {{"zpos", "posz", "positionz", "position2", "centrez", "centerz", "coordz", "zcoord",
         "coordinatez", "coordinates2", "points2", "coord2", "pos2", "particlezcoordinate",
         "particlepositionz", "particlez"},
        {"zc", "cz", "x3"}}},
      {"vx",
       {{"velx", "velocityx", "xvel", "velocity0", "xvelocity", "linvelvec0", "linearvelocity0",
         "linearvelocityx", "velocitylin0", "particlevelocityx"},
        {"v1", "ux", "v0"},
        {"v0", "vel0"}}},
      {"vy",
       {{"vely", "velocityy", "yvel", "velocity1", "yvelocity", "linvelvec1", "linearvelocity1",
         "linearvelocityy", "velocitylin1", "particlevelocityy"},
        {"v2", "uy"},
        {"v1", "vel1"}}},
      {"vz",
       {{"velz", "velocityz", "zvel", "velocity2", "zvelocity", "linvelvec2", "linearvelocity2",
         "linearvelocityz", "velocitylin2", "particlevelocityz"},
        {"v3", "uz"},
        {"v2", "vel2"}}},
      {"spin",
       {{"omegaz", "omega2", "angularvelocityz", "angularvelocity2", "angvelz", "angvelvec2",
         "velocityang2"},
        {"wz", "omega", "angularvelocity"},
        {"w2", "angvel2"}}},
      {"spin_x",
       {{"omegax", "omega0", "angularvelocityx", "angularvelocity0", "angvelx", "angvelvec0",
         "velocityang0"},
        {"wx"},
        {"w0", "angvel0"}}},
      {"spin_y",
       {{"omegay", "omega1", "angularvelocityy", "angularvelocity1", "angvely", "angvelvec1",
         "velocityang1"},
        {"wy"},
        {"w1", "angvel1"}}},
      {"ix", {{"image0", "imageflag0", "imagex"}, {}, {"i0"}}},
      {"iy", {{"image1", "imageflag1", "imagey"}, {}, {"i1"}}},
      {"iz", {{"image2", "imageflag2", "imagez"}, {}, {"i2"}}},
      {"radius", {{"rad", "r", "radii", "particleradius"}, {"rp"}}},
      {"diameter", {{"diam", "dia", "particlediameter"}, {"d", "dp", "size", "particlesize"}}},
      {"mass", {{"m", "particlemass"}, {}}},
      {"density", {{"rho", "dens", "particledensity"}, {"rhop"}}},
      {"i",
       {{"id1", "idi", "ida", "particle1", "particlei", "particleid1", "particle1id", "grain1",
         "grain1id", "grainid1", "ball1", "ball1id", "body1", "end1", "end1id", "bodyid1", "atom1",
         "element1id", "atomi"},
        {"ids1", "p1", "first", "from", "a", "element1", "source", "particleid", "particle",
         "ballid", "grainid", "particleidentifiers1"}}},
      {"j",
       {{"id2", "idj", "idb", "particle2", "particlej", "particleid2", "particle2id", "grain2",
         "grain2id", "grainid2", "ball2", "ball2id", "body2", "end2", "end2id", "bodyid2", "atom2",
         "element2id", "atomj"},
        {"ids2", "p2", "second", "to", "b", "element2", "target", "geometryid", "geometry",
         "wallid", "facetid", "particleidentifiers2"}}},
      {"fx",
       {{"forcex", "xforce", "force0", "contactforcex", "globalforcex", "forceglobalx",
         "contactforce0", "totalforce0", "forces0"},
        {"f1", "ftotx"},
        {"f0"}}},
      {"fy",
       {{"forcey", "yforce", "force1", "contactforcey", "globalforcey", "forceglobaly",
         "contactforce1", "totalforce1", "forces1"},
        {"f2", "ftoty"},
        {"f1"}}},
      {"fz",
       {{"forcez", "zforce", "force2", "contactforcez", "globalforcez", "forceglobalz",
         "contactforce2", "totalforce2", "forces2"},
        {"f3", "ftotz"},
        {"f2"}}},
      {"fnx",
       {{"forcenormalx", "normalforcex", "forcenormal0", "normalforce0", "forcen0"},
        {"fxn"},
        {"fn0"}}},
      {"fny",
       {{"forcenormaly", "normalforcey", "forcenormal1", "normalforce1", "forcen1"},
        {"fyn"},
        {"fn1"}}},
      {"fnz",
       {{"forcenormalz", "normalforcez", "forcenormal2", "normalforce2", "forcen2"},
        {"fzn"},
        {"fn2"}}},
      {"ftx",
       {{"forcetangentialx", "tangentialforcex", "shearforcex", "forcetangential0", "fsx",
         "fshearx", "shearx", "shear0", "tangentialforce0", "shearforce0", "forcet0"},
        {"fxt", "fxs"},
        {"ft0", "fs0"}}},
      {"fty",
       {{"forcetangentialy", "tangentialforcey", "shearforcey", "forcetangential1", "fsy",
         "fsheary", "sheary", "shear1", "tangentialforce1", "shearforce1", "forcet1"},
        {"fyt", "fys"},
        {"ft1", "fs1"}}},
      {"ftz",
       {{"forcetangentialz", "tangentialforcez", "shearforcez", "forcetangential2", "fsz",
         "fshearz", "shearz", "shear2", "tangentialforce2", "shearforce2", "forcet2"},
        {"fzt", "fzs"},
        {"ft2", "fs2"}}},
      {"px",
       {{"contactx", "contactpointx", "pointx", "xcontact", "contactpoint0", "contactposx",
         "contactpositionx"},
        {"cpx"}}},
      {"py",
       {{"contacty", "contactpointy", "pointy", "ycontact", "contactpoint1", "contactposy",
         "contactpositiony"},
        {"cpy"}}},
      {"pz",
       {{"contactz", "contactpointz", "pointz", "zcontact", "contactpoint2", "contactposz",
         "contactpositionz"},
        {"cpz"}}},
      {"nx", {{"normalx", "xnormal", "normal0"}, {}}},
      {"ny", {{"normaly", "ynormal", "normal1"}, {}}},
      {"nz", {{"normalz", "znormal", "normal2"}, {}}},
      {"fn", {{}, {"normalforce", "forcenormal", "fnormal", "force"}}},
      {"ft", {{}, {"tangentialforce", "shearforce", "fs"}}},
  };
  return all;
}

}  // namespace

std::string plain_column_name(const std::string& name) {
  std::string out;
  for (const char ch : name.substr(0, name.find_first_of("([{"))) {
    const auto c = static_cast<unsigned char>(ch);
    if (std::isalnum(c) != 0) out += static_cast<char>(std::tolower(c));
  }
  // "force[0]", "Points:0": the number of a component counts.
  const std::size_t open = name.find('[');
  if (open != std::string::npos && open + 2 < name.size() && name[open + 2] == ']' &&
      std::isdigit(static_cast<unsigned char>(name[open + 1])) != 0)
    out += name[open + 1];
  return out;
}

std::string counted_from_zero(const std::string& plain, const std::vector<std::string>& all) {
  static const std::set<std::string> stems = [] {
    std::set<std::string> out;
    for (const auto& [ours, others] : all_synonyms())
      for (const auto* names : {&others.sure, &others.components})
        for (const std::string& name : *names)
          if (name.ends_with('0')) out.insert(name.substr(0, name.size() - 1));
    return out;
  }();
  if (plain.empty() || plain.back() < '0' || plain.back() > '3') return plain;
  const std::string stem = plain.substr(0, plain.size() - 1);
  const auto there = [&](const char* number) {
    return std::find(all.begin(), all.end(), stem + number) != all.end();
  };
  // Bodies count from 1: "id:0" and "id:1" of ParaView are id1 and id2.
  const std::vector<std::string>& first = synonyms_of("i").sure;
  if (there("0") && std::find(first.begin(), first.end(), stem + "1") != first.end())
    return stem + static_cast<char>(plain.back() + 1);
  if (plain.back() == '0') return plain;
  if (stems.find(stem) == stems.end() || there("0")) return plain;
  // Half a vector is none.
  if (!there("1") || !there("2")) return "";
  return stem + static_cast<char>(plain.back() - 1);
}

const Synonyms& synonyms_of(const std::string& ours) {
  static const Synonyms none;
  const auto at = all_synonyms().find(ours);
  return at == all_synonyms().end() ? none : at->second;
}

std::string same_meaning(const std::string& ours, const std::vector<std::string>& columns) {
  std::vector<std::string> wanted{ours};
  const Synonyms& known = synonyms_of(ours);
  wanted.insert(wanted.end(), known.sure.begin(), known.sure.end());
  wanted.insert(wanted.end(), known.likely.begin(), known.likely.end());
  const auto column_of = [&](const std::string& word) {
    const auto at = std::find_if(columns.begin(), columns.end(), [&](const std::string& column) {
      return plain_column_name(column) == plain_column_name(word);
    });
    return at == columns.end() ? std::string() : *at;
  };
  for (std::string word : wanted) {
    // Components may be counted from 0: with x0 there, x1 is the second.
    const bool counted = !word.empty() && word.back() >= '1' && word.back() <= '3';
    if (counted && !column_of(word.substr(0, word.size() - 1) + "0").empty()) --word.back();
    if (const std::string column = column_of(word); !column.empty()) return column;
  }
  return "";
}

bool is_known_name(const std::string& name) {
  static const std::set<std::string> known = [] {
    std::set<std::string> out;
    for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
      for (const OurColumn& column : our_columns(kind)) out.insert(plain_column_name(column.name));
    for (const auto& [ours, others] : all_synonyms())
      out.insert(others.sure.begin(), others.sure.end());
    return out;
  }();
  return known.find(plain_column_name(name)) != known.end();
}

}  // namespace grainfield::coupling
