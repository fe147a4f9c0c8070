// Numbers as an unevaluated sum of two floating-point values, hi + lo with |lo| <= ulp(hi) / 2: about 48 bits
// from float32. Used where float32 alone cancels: the projected centre of a primitive seen from thousands of
// ångström away (projection.glsl), and a distance that is stored as one float32.
//
// Dekker, Numerische Mathematik 18 (1971), doi 10.1007/BF01397083; Knuth, TAOCP 2, 4.2.2. PRECISE keeps
// compilers from reassociating; C++ is compiled without contraction (CMakeLists.txt).

struct Split {
  real hi;
  real lo;
};

FN Split makeSplit(real hi, real lo) {
  Split s;
  s.hi = hi;
  s.lo = lo;
  return s;
}

// a + b exactly.
FN Split twoSum(real a, real b) {
  PRECISE real s = a + b;
  PRECISE real bPart = s - a;
  PRECISE real aPart = s - bPart;
  PRECISE real aRest = a - aPart;
  PRECISE real bRest = b - bPart;
  PRECISE real rest = aRest + bRest;
  return makeSplit(s, rest);
}

// The upper half of a's bits (Veltkamp).
FN real upperHalf(real a) {
  PRECISE real c = real(SPLITTER) * a;
  PRECISE real big = c - a;
  PRECISE real upper = c - big;
  return upper;
}

// a * b exactly (barring overflow and underflow).
FN Split twoProduct(real a, real b) {
  PRECISE real p = a * b;
  PRECISE real aHi = upperHalf(a);
  PRECISE real aLo = a - aHi;
  PRECISE real bHi = upperHalf(b);
  PRECISE real bLo = b - bHi;
  PRECISE real e1 = aHi * bHi - p;
  PRECISE real e2 = e1 + aHi * bLo;
  PRECISE real e3 = e2 + aLo * bHi;
  PRECISE real e4 = e3 + aLo * bLo;
  return makeSplit(p, e4);
}

FN Split addSplit(Split a, Split b) {
  Split s = twoSum(a.hi, b.hi);
  PRECISE real lo = s.lo + (a.lo + b.lo);
  return twoSum(s.hi, lo);
}

FN Split negateSplit(Split a) {
  return makeSplit(-a.hi, -a.lo);
}

FN Split multiplySplit(Split a, Split b) {
  Split p = twoProduct(a.hi, b.hi);
  PRECISE real lo = p.lo + (a.hi * b.lo + a.lo * b.hi);
  return twoSum(p.hi, lo);
}

// sqrt(a); a.hi must not be negative.
FN Split sqrtSplit(Split a) {
  if (a.hi <= real(0)) return makeSplit(real(0), real(0));
  PRECISE real s = sqrt(a.hi);
  Split rest = addSplit(a, negateSplit(twoProduct(s, s)));
  PRECISE real correction = rest.hi / (real(2) * s);
  return twoSum(s, correction);
}
