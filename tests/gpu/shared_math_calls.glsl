// Every function of shaders/shared/ behind one signature, numbers in and numbers out, in the dialect of
// shaders/shared/README.md: shared_math_test.cpp compiles this text as C++ in float and in double and runs it
// as GLSL.

struct Cell {
  real in_[64];
  real out_[16];
};

FN vec3 in3(Cell c, int i) {
  return vec3(c.in_[i], c.in_[i + 1], c.in_[i + 2]);
}
FN vec4 in4(Cell c, int i) {
  return vec4(c.in_[i], c.in_[i + 1], c.in_[i + 2], c.in_[i + 3]);
}
FN Split inSplit(Cell c, int i) {
  return makeSplit(c.in_[i], c.in_[i + 1]);
}

// Takes in_[0] to in_[43].
FN ViewBlock inView(Cell c) {
  ViewBlock v;
  v.xRowHi = in4(c, 0);
  v.yRowHi = in4(c, 4);
  v.zRowHi = in4(c, 8);
  v.xRowLo = in4(c, 12);
  v.yRowLo = in4(c, 16);
  v.zRowLo = in4(c, 20);
  v.scale = in4(c, 24);
  v.center = in4(c, 28);
  v.depth = in4(c, 32);
  v.depthMap = in4(c, 36);
  v.tile = in4(c, 40);
  return v;
}

FN void out3(INOUT(Cell) c, int i, vec3 v) {
  c.out_[i] = v.x;
  c.out_[i + 1] = v.y;
  c.out_[i + 2] = v.z;
}

FN void outSplit(INOUT(Cell) c, int i, Split s) {
  c.out_[i] = s.hi;
  c.out_[i + 1] = s.lo;
}

FN void outChord(INOUT(Cell) c, Chord chord) {
  c.out_[0] = chord.hit ? real(1) : real(0);
  out3(c, 1, chord.entry);
  out3(c, 4, chord.exit);
  out3(c, 7, chord.entryNormal);
  out3(c, 10, chord.exitNormal);
}

// double_float.glsl
FN void callMakeSplit(INOUT(Cell) c) {
  outSplit(c, 0, makeSplit(c.in_[0], c.in_[1]));
}
FN void callTwoSum(INOUT(Cell) c) {
  outSplit(c, 0, twoSum(c.in_[0], c.in_[1]));
}
FN void callUpperHalf(INOUT(Cell) c) {
  c.out_[0] = upperHalf(c.in_[0]);
}
FN void callTwoProduct(INOUT(Cell) c) {
  outSplit(c, 0, twoProduct(c.in_[0], c.in_[1]));
}
FN void callAddSplit(INOUT(Cell) c) {
  outSplit(c, 0, addSplit(inSplit(c, 0), inSplit(c, 2)));
}
FN void callNegateSplit(INOUT(Cell) c) {
  outSplit(c, 0, negateSplit(inSplit(c, 0)));
}
FN void callMultiplySplit(INOUT(Cell) c) {
  outSplit(c, 0, multiplySplit(inSplit(c, 0), inSplit(c, 2)));
}
FN void callSqrtSplit(INOUT(Cell) c) {
  outSplit(c, 0, sqrtSplit(inSplit(c, 0)));
}

// octahedral.glsl
FN void callAwayFromZero(INOUT(Cell) c) {
  c.out_[0] = awayFromZero(c.in_[0]);
}
FN void callEncodeNormal(INOUT(Cell) c) {
  vec2 e = encodeNormal(in3(c, 0));
  c.out_[0] = e.x;
  c.out_[1] = e.y;
}
FN void callDecodeNormal(INOUT(Cell) c) {
  out3(c, 0, decodeNormal(vec2(c.in_[0], c.in_[1])));
}

// projection.glsl; the view comes first, the other arguments from in_[44] on
FN void callIsPerspective(INOUT(Cell) c) {
  c.out_[0] = isPerspective(inView(c)) ? real(1) : real(0);
}
FN void callDotRow(INOUT(Cell) c) {
  ViewBlock view = inView(c);
  outSplit(c, 0, dotRow(view.xRowHi, view.xRowLo, in3(c, 44), in3(c, 47)));
}
FN void callQuotient(INOUT(Cell) c) {
  outSplit(c, 0, quotient(inSplit(c, 0), inSplit(c, 2)));
}
FN void callDepthOf(INOUT(Cell) c) {
  outSplit(c, 0, depthOf(inView(c), inSplit(c, 44)));
}
FN void callTransformPoint(INOUT(Cell) c) {
  RowProducts p = transformPoint(inView(c), in3(c, 44), in3(c, 47));
  outSplit(c, 0, p.x);
  outSplit(c, 2, p.y);
  outSplit(c, 4, p.z);
}
FN void callProjectCenter(INOUT(Cell) c) {
  ProjectedCenter p = projectCenter(inView(c), in3(c, 44), in3(c, 47));
  outSplit(c, 0, p.pixelX);
  outSplit(c, 2, p.pixelY);
  c.out_[4] = p.view.x;
  c.out_[5] = real(0);
  c.out_[6] = p.view.y;
  c.out_[7] = real(0);
  c.out_[8] = p.view.z;
  c.out_[9] = real(0);
  c.out_[10] = p.depth;
  c.out_[11] = real(0);
}
FN void callCenterRange(INOUT(Cell) c) {
  outSplit(c, 0, centerRange(inView(c), in3(c, 44), in3(c, 47)));
}
FN void callTurn(INOUT(Cell) c) {
  out3(c, 0, turn(inView(c), in3(c, 44)));
}
FN void callRayDirection(INOUT(Cell) c) {
  out3(c, 0, rayDirection(inView(c), vec2(c.in_[44], c.in_[45])));
}
FN void callNearEye(INOUT(Cell) c) {
  c.out_[0] = nearEye(inView(c), c.in_[44], c.in_[45]) ? real(1) : real(0);
}
FN void callRayPoint(INOUT(Cell) c) {
  out3(c, 0,
       rayPoint(inView(c), vec2(c.in_[44], c.in_[45]), vec2(c.in_[46], c.in_[47]), vec2(c.in_[48], c.in_[49]),
                in3(c, 50), c.in_[53], c.in_[54] > real(0.5)));
}
FN void callDepthValue(INOUT(Cell) c) {
  c.out_[0] = depthValue(inView(c), c.in_[44]);
}
FN void callViewPoint(INOUT(Cell) c) {
  out3(c, 0, viewPoint(inView(c), vec2(c.in_[44], c.in_[45]), c.in_[46]));
}
FN void callRayDistance(INOUT(Cell) c) {
  c.out_[0] = rayDistance(inView(c), in3(c, 44), inSplit(c, 47), in3(c, 49));
}
FN void outExtent(INOUT(Cell) c, Extent e) {
  c.out_[0] = e.bounded ? real(1) : real(0);
  c.out_[1] = e.low;
  c.out_[2] = e.high;
}
FN void callTangentExtent(INOUT(Cell) c) {
  outExtent(c, tangentExtent(inView(c), c.in_[44], c.in_[45], c.in_[46], c.in_[47], c.in_[48]));
}
FN void callEllipsoidExtent(INOUT(Cell) c) {
  outExtent(c, ellipsoidExtent(inView(c), c.in_[44], c.in_[45], c.in_[46], in3(c, 47), in3(c, 50)));
}
FN void callProjectedExtent(INOUT(Cell) c) {
  Extent e = projectedExtent(inView(c), c.in_[44], c.in_[45], c.in_[46], c.in_[47], c.in_[48]);
  c.out_[0] = e.bounded ? real(1) : real(0);
  c.out_[1] = e.low;
  c.out_[2] = e.high;
}

// quadrics.glsl
FN void callMissedChord(INOUT(Cell) c) {
  outChord(c, missedChord());
}
FN void callSphereChord(INOUT(Cell) c) {
  outChord(c, sphereChord(in3(c, 0), in3(c, 3), c.in_[6]));
}
FN void callCylinderChord(INOUT(Cell) c) {
  outChord(c, cylinderChord(in3(c, 0), in3(c, 3), in3(c, 6), c.in_[9], c.in_[10]));
}
FN void callEllipsoidChord(INOUT(Cell) c) {
  outChord(c, ellipsoidChord(in3(c, 0), in3(c, 3), in3(c, 6), in3(c, 9), in3(c, 12), in3(c, 15)));
}

// metaball.glsl
FN void callSexticKernel(INOUT(Cell) c) {
  c.out_[0] = sexticKernel(c.in_[0]);
}
FN void callSexticSlope(INOUT(Cell) c) {
  c.out_[0] = sexticSlope(c.in_[0]);
}
FN void callQuarticKernel(INOUT(Cell) c) {
  c.out_[0] = quarticKernel(c.in_[0]);
}
FN void callQuarticSlope(INOUT(Cell) c) {
  c.out_[0] = quarticSlope(c.in_[0]);
}
FN void callPowerKernel(INOUT(Cell) c) {
  c.out_[0] = powerKernel(c.in_[0], int(c.in_[1]));
}
FN void callPowerSlope(INOUT(Cell) c) {
  c.out_[0] = powerSlope(c.in_[0], int(c.in_[1]));
}
FN Window inWindow(Cell c) {
  return windowOn(c.in_[0], c.in_[1], c.in_[2], c.in_[3], c.in_[4]);
}
FN void callWindowOn(INOUT(Cell) c) {
  Window w = inWindow(c);
  c.out_[0] = w.w0;
  c.out_[1] = w.w1;
  c.out_[2] = w.w2;
}
FN void callQuarticPiece(INOUT(Cell) c) {
  QuarticPiece p = quarticPiece(inWindow(c));
  for (int i = 0; i < 5; ++i) c.out_[i] = p.c[i];
}
FN void callSexticPiece(INOUT(Cell) c) {
  SexticPiece p = sexticPiece(inWindow(c));
  for (int i = 0; i < 7; ++i) c.out_[i] = p.c[i];
}
// in_[5]: alpha; in_[6]: the first coefficient that is shown
FN void callPowerPiece(INOUT(Cell) c) {
  PowerPiece p = powerPiece(inWindow(c), int(c.in_[5]));
  int first = int(c.in_[6]);
  for (int i = 0; i < 16; ++i) c.out_[i] = first + i <= 2 * kMostExponent ? p.c[first + i] : real(0);
}
