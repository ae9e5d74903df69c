// SPDX-License-Identifier: Apache-2.0
// The executable that the tests' precompiled header belongs to.
int main() { return 0; }
