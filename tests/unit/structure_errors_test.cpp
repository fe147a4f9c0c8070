// What is no structure is refused with one line that names the file, the place and the remedy; nothing hangs
// or crashes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "core/bonds.h"
#include "core/error.h"
#include "tests/unit/structure_files.h"

namespace meniscus {
namespace {

using test::dataFile;
using test::readFile;
using test::TemporaryFile;

void expectRefused(const std::filesystem::path& path, std::string_view part) {
  try {
    readFile(path);
    ADD_FAILURE() << path << " was read";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find(path.string()), std::string::npos) << line;
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

std::string bytesOf(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string gzip(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST(Refused, whatIsNotThere) {
  expectRefused("/nonexistent/x.pdb", "no such file");
  expectRefused(std::filesystem::temp_directory_path(), "is a folder");
  expectRefused(TemporaryFile("empty.pdb", "").path(), "is empty");
  expectRefused(TemporaryFile("blank.pdb", "\n\n  \n").path(), "nothing but blanks");
}

TEST(Refused, whatIsNoStructure) {
  expectRefused(dataFile("web_page.pdb"), "web page");
  expectRefused(dataFile("no_atoms.pdb"), "no ATOM or HETATM");
  expectRefused(dataFile("small_molecule.cif"), "fractional");
  expectRefused(dataFile("water.gro"), "PDB and mmCIF");
  expectRefused(TemporaryFile("x.pdb", std::string_view("\x7f"
                                                        "ELF\0\0\1\2",
                                                        8))
                    .path(),
                "binary");
  expectRefused(TemporaryFile("x.cif", "{\"data_X\": {}}").path(), "JSON");
  expectRefused(TemporaryFile("x.pdb", "Dear reader,\nthis is a letter.\n").path(), "no structure");
  expectRefused(TemporaryFile("x.cif", "data_x\n_cell.length_a 10\n").path(), "no atoms");
  expectRefused(TemporaryFile("x.xtc", std::string_view("\0\0\x07\xCB\0\0\0\1", 8)).path(), "XTC");
}

TEST(Refused, coordinatesWithTheirLine) {
  expectRefused(dataFile("bad_coordinate.pdb"), "line 3: the x coordinate 'abc'");
  expectRefused(dataFile("nan_coordinate.pdb"), "line 3: the y coordinate 'nan'");
  expectRefused(dataFile("truncated_line.pdb"), "line 4: the y coordinate");
  expectRefused(dataFile("nan_coordinate.cif"), "line 25");
  expectRefused(dataFile("absurd_coordinate.cif"), "no usable position");
}

TEST(Refused, truncatedAndDamagedFiles) {
  expectRefused(dataFile("truncated.cif"), "truncated");
  const std::string packed = gzip(bytesOf(dataFile("plain.pdb")));
  const TemporaryFile whole("whole.pdb.gz", packed);
  EXPECT_EQ(readFile(whole.path()).molecule().atomCount(), 8u);
  expectRefused(TemporaryFile("x.pdb.gz", packed.substr(0, packed.size() / 2)).path(), "truncated");
  expectRefused(TemporaryFile("x.pdb.gz", packed.substr(0, 12)).path(), "truncated");
  std::string damaged = packed;
  damaged[damaged.size() - 6] = static_cast<char>(~damaged[damaged.size() - 6]);  // in the check sum
  expectRefused(TemporaryFile("x.pdb.gz", damaged).path(), "damaged");
}

TEST(Gzip, isRecognisedByContentAndMayHaveMembers) {
  const std::string text = bytesOf(dataFile("plain.pdb"));
  const TemporaryFile misnamed("misnamed.txt", gzip(text.substr(0, 300)) + gzip(text.substr(300)));
  EXPECT_EQ(readFile(misnamed.path()).molecule().atomCount(), 8u);
  const TemporaryFile notPacked("plain.cif.gz", text);
  EXPECT_EQ(readFile(notPacked.path()).molecule().atomCount(), 8u);
}

TEST(Gzip, bombsAreRefusedEarly) {
  const std::string member = gzip(std::string(std::size_t{16} << 20, '\n'));
  std::string bomb = gzip(bytesOf(dataFile("plain.pdb")));
  for (int i = 0; i < 9; ++i) bomb += member;
  const TemporaryFile file("bomb.pdb.gz", bomb);
  expectRefused(file.path(), "times its size");
}

TEST(Robust, longLinesDeepNestingAndGarbage) {
  expectRefused(TemporaryFile("x.pdb", "HEADER\n" + std::string(5'000'000, 'x')).path(), "no ATOM");
  std::string deep = "data_x\n";
  for (int i = 0; i < 100'000; ++i) deep.append("save_").append(std::to_string(i)).append("\n");
  expectRefused(TemporaryFile("x.cif", deep).path(), "line");
  expectRefused(TemporaryFile("x.cif", "data_x\nloop_\n" + std::string(2'000'000, '(')).path(), "mmCIF");
  std::mt19937 random(7);
  std::string garbage(3'000'000, ' ');
  for (char& c : garbage) c = static_cast<char>(32 + random() % 95);
  expectRefused(TemporaryFile("x.pdb", garbage).path(), "no structure");
}

TEST(Robust, mutatedFilesAreReadOrRefused) {
  std::mt19937 random(20);
  for (const char* name : {"altlocs.pdb", "assembly.pdb", "link_ssbond.pdb", "assembly.cif",
                           "connections.cif", "component.cif"}) {
    const std::string original = bytesOf(dataFile(name));
    for (int round = 0; round < 100; ++round) {
      std::string text = original;
      for (int edit = 0; edit < 6; ++edit) {
        const std::size_t at = random() % text.size();
        const std::size_t kind = random() % 4;
        if (kind == 0) text[at] = static_cast<char>(random());
        if (kind == 1) text.erase(at, 1 + random() % 40);
        if (kind == 2) text.insert(at, text.substr(random() % text.size(), random() % 90));
        if (kind == 3) text.insert(at, std::string(random() % 12, '9'));
        if (text.empty()) text.assign(1, ' ');
      }
      const TemporaryFile file("mutated", text);
      Logger logger;
      try {
        StructureFile read = readStructure(file.path(), {}, logger);
        for (Molecule& m : read.models) {
          addMissingBonds(m, logger);
          ASSERT_TRUE(std::all_of(m.bonds.begin(), m.bonds.end(),
                                  [&m](const Bond& b) { return b.a < b.b && b.b < m.atomCount(); }));
        }
      } catch (const InputError&) {
        continue;
      }
    }
  }
}

}  // namespace
}  // namespace meniscus
