// Which instruction set a kernel file is being compiled for; set by CMake. See kernels.hpp.
#pragma once

#ifndef FLOWDLO_ISA
#define FLOWDLO_ISA baseline
#endif

#include "reference/kernels.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

void pack(const float* weight, int out, int in, float* panels);
void linear(const LinearBlock& block);
void narrow(const NarrowBlock& block);
void layer_norm(const LayerNormBlock& block);
void attention(const AttentionBlock& block);
void point_convolution(const PointRows& rows);
void square_convolution(const SquareBlocks& blocks);

}  // namespace flowdlo::reference::FLOWDLO_ISA
