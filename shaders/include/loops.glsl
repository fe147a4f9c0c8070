// Mesa's software driver ends every loop once all loops of a group of pixels together have run 65,535 times:
// from then on each runs once. true: this has happened, and nothing that was computed can be relied on. two:
// 2, from a uniform, so that the loop stays one.
bool loopsAreEnded(int two) {
  int runs = 0;
  for (int i = 0; i < two; ++i) ++runs;
  return runs < two;
}
