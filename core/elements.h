#pragma once
// Chemical elements: symbols, colours, radii. Index = atomic number, 0 = unknown.

#include <cstdint>
#include <string_view>

namespace meniscus {

inline constexpr int kElementCount = 119;  ///< 0 (unknown) to 118 (Og)

enum class RadiusSet : std::uint8_t {
  bondi,  ///< Bondi 1964 (doi 10.1021/j100785a001), H = 1.20; Mantina 2009 (10.1021/jp8111556) where Bondi is
          ///< silent
  alvarez  ///< Alvarez 2013 (doi 10.1039/c3dt50599e)
};

/// "X" for unknown, otherwise the usual symbol ("Fe").
std::string_view elementSymbol(std::uint8_t element);

/// Atomic number of a symbol in any letter case, D and T being hydrogen; 0 if unknown.
std::uint8_t elementFromSymbol(std::string_view symbol);

/// van der Waals radius [Å]. Elements that the set lacks take the set's fallback, 2.0 Å.
float vanDerWaalsRadius(std::uint8_t element, RadiusSet set);

/// Covalent radius [Å], Cordero 2008 (doi 10.1039/b801115j); unknown as carbon, beyond Cm as Cm.
float covalentRadius(std::uint8_t element);

/// Jmol colour as 0xRRGGBB (sRGB).
std::uint32_t elementColor(std::uint8_t element);

/// Metals; the metalloids B, Si, Ge, As, Sb, Te and At are none.
bool isMetal(std::uint8_t element);

}  // namespace meniscus
