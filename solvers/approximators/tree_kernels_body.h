// The loops of TreeKernels over `Floats`, `Mask` and `Counts` of kLanes lanes. Included by each of the
// sources that define these, inside their namespace, so no guard and no includes: tree_kernels_portable.cpp,
// tree_kernels_avx2.cpp and tree_kernels_avx512.cpp.

constexpr std::size_t kBlockVectors = 256;  // sums in single precision are flushed to double after so many

inline Mask first_of(std::size_t size) {
  return first(size < kLanes ? size : kLanes);
}

// Both ends of a column. The last full vector may overlap the one before, which changes neither end.
inline void find_range(const float* x, std::size_t size, float& least_out, float& most_out) {
  if (size < kLanes) {
    const Mask mask = first(size);
    least_out = least(load_part(x, mask, all(kInfinity)));
    most_out = most(load_part(x, mask, all(-kInfinity)));
    return;
  }
  Floats low0 = load(x);
  Floats high0 = low0;
  Floats low1 = load(x + size - kLanes);
  Floats high1 = low1;
  std::size_t i = kLanes;
  for (; i + 2 * kLanes <= size; i += 2 * kLanes) {
    const Floats a = load(x + i);
    const Floats b = load(x + i + kLanes);
    low0 = min(low0, a);
    high0 = max(high0, a);
    low1 = min(low1, b);
    high1 = max(high1, b);
  }
  if (i + kLanes <= size) {
    const Floats a = load(x + i);
    low0 = min(low0, a);
    high0 = max(high0, a);
  }
  least_out = least(min(low0, low1));
  most_out = most(max(high0, high1));
}

inline void find_ranges(const SampleBlock& block, Candidate* candidates, std::size_t size) {
  for (std::size_t c = 0; c < size; ++c) {
    find_range(block.column(candidates[c].feature), block.size(), candidates[c].low, candidates[c].high);
  }
}

template <std::size_t kSize, bool kWeighted>
void find_low_sides_of(const SampleBlock& block, Candidate* candidates) {
  const float* x[kSize];
  Floats threshold[kSize];
  Counts count[kSize];
  for (std::size_t c = 0; c < kSize; ++c) {
    x[c] = block.column(candidates[c].feature);
    threshold[c] = all(candidates[c].threshold);
    count[c] = no_counts();
    candidates[c].weight = candidates[c].sum = 0;
  }
  const float* y = block.outputs();
  const float* w = kWeighted ? block.weights() : nullptr;
  const std::size_t size = block.size();
  for (std::size_t begin = 0; begin < size; begin += kBlockVectors * kLanes) {
    const std::size_t end = size - begin < kBlockVectors * kLanes ? size : begin + kBlockVectors * kLanes;
    Floats sum[kSize];
    Floats weight[kSize];
    for (std::size_t c = 0; c < kSize; ++c) sum[c] = weight[c] = all(0);
    std::size_t i = begin;
    const auto step = [&](Mask valid) {
      const Floats weights = kWeighted ? load(w + i) : all(0);
      const Floats outputs = kWeighted ? mul(weights, load(y + i)) : load(y + i);
#pragma GCC unroll 4
      for (std::size_t c = 0; c < kSize; ++c) {
        const Mask low = both(valid, at_most(load(x[c] + i), threshold[c]));
        sum[c] = add_where(sum[c], low, outputs);
        if (kWeighted) weight[c] = add_where(weight[c], low, weights);
        count[c] = add_count(count[c], low);
      }
    };
    for (; i + kLanes <= end; i += kLanes) step(first(kLanes));
    if (i < end) step(first(end - i));
    for (std::size_t c = 0; c < kSize; ++c) {
      candidates[c].sum += static_cast<double>(total(sum[c]));
      if (kWeighted) candidates[c].weight += static_cast<double>(total(weight[c]));
    }
  }
  for (std::size_t c = 0; c < kSize; ++c) {
    candidates[c].count = counted(count[c]);
    if (!kWeighted) candidates[c].weight = static_cast<double>(candidates[c].count);
  }
}

template <bool kWeighted>
void find_low_sides_of(const SampleBlock& block, Candidate* candidates, std::size_t size) {
  std::size_t c = 0;
  for (; c + 4 <= size; c += 4) find_low_sides_of<4, kWeighted>(block, candidates + c);
  for (; c + 2 <= size; c += 2) find_low_sides_of<2, kWeighted>(block, candidates + c);
  for (; c < size; ++c) find_low_sides_of<1, kWeighted>(block, candidates + c);
}

// The same of rows that fit into a vector and have no weights.
inline void find_low_sides_of_few(const SampleBlock& block, Candidate* candidates, std::size_t size) {
  const Mask valid = first(block.size());
  const Floats outputs = load(block.outputs());
  for (std::size_t c = 0; c < size; ++c) {
    Candidate& candidate = candidates[c];
    const Mask low = both(valid, at_most(load(block.column(candidate.feature)), all(candidate.threshold)));
    candidate.sum = static_cast<double>(total(add_where(all(0), low, outputs)));
    candidate.count = counted(add_count(no_counts(), low));
    candidate.weight = static_cast<double>(candidate.count);
  }
}

inline void find_low_sides(const SampleBlock& block, Candidate* candidates, std::size_t size) {
  if (block.weighted) {
    find_low_sides_of<true>(block, candidates, size);
  } else if (block.size() <= kLanes) {
    find_low_sides_of_few(block, candidates, size);
  } else {
    find_low_sides_of<false>(block, candidates, size);
  }
}

// Sums in double precision: a leaf's value is as exact as its samples.
inline OutputSums sum_outputs(const SampleBlock& block) {
  OutputSums sums;
  const float* y = block.outputs();
  const std::size_t size = block.size();
  find_range(y, size, sums.least, sums.most);
  Doubles sum = no_doubles();
  Doubles weight = no_doubles();
  for (std::size_t i = 0; i < size; i += kLanes) {
    const Mask valid = first_of(size - i);
    const Floats outputs = load_part(y + i, valid, all(0));
    if (block.weighted) {
      const Floats weights = load_part(block.weights() + i, valid, all(0));
      weight = add(weight, weights);
      sum = add_product(sum, weights, outputs);
    } else {
      sum = add(sum, outputs);
    }
  }
  sums.sum = total(sum);
  sums.weight = block.weighted ? total(weight) : static_cast<double>(size);
  return sums;
}

// Writes rows of the block to `rows`, column after column (1, inputs, output), each about its centre and
// times the root of its weight; those that are not on the low side as 0. Returns the number of vectors.
inline std::size_t centre_rows(const SampleBlock& block, std::size_t begin, std::uint32_t feature,
                               float threshold, const float* centre, float* rows) {
  const std::size_t size = block.size() - begin < kProductRows ? block.size() - begin : kProductRows;
  const std::size_t columns = block.inputs + 1;
  const float* x = block.column(feature) + begin;
  for (std::size_t i = 0; i < size; i += kLanes) {
    const Mask low = both(first_of(size - i), at_most(load(x + i), all(threshold)));
    const Floats root =
        block.weighted ? root_of(load_part(block.weights() + begin + i, low, all(0))) : keep(low, all(1));
    store(rows + i, root);
    for (std::size_t c = 0; c < columns; ++c) {
      const Floats difference = keep(low, sub(load(block.column(c) + begin + i), all(centre[c])));
      store(rows + (c + 1) * kProductRows + i, block.weighted ? mul(root, difference) : difference);
    }
  }
  return (size + kLanes - 1) / kLanes;
}

// Adds products of column u with kSize columns from v on to their sums.
template <std::size_t kSize>
void add_products(const float* u, const float* v, std::size_t vectors, float* sums) {
  Floats sum[kSize];
  for (std::size_t j = 0; j < kSize; ++j) sum[j] = load(sums + j * kLanes);
  for (std::size_t i = 0; i < vectors * kLanes; i += kLanes) {
    const Floats factor = load(u + i);
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kSize; ++j) {
      sum[j] = add(sum[j], mul(factor, load(v + j * kProductRows + i)));
    }
  }
  for (std::size_t j = 0; j < kSize; ++j) store(sums + j * kLanes, sum[j]);
}

inline void low_products(const SampleBlock& block, std::uint32_t feature, float threshold,
                         const float* centre, float* work, double* products) {
  const std::size_t columns = block.inputs + 2;
  const std::size_t pairs = triangle(columns);
  float* rows = aligned(work);
  float* sums = rows + columns * kProductRows;
  const auto clear = [&] {
    for (std::size_t p = 0; p < pairs; ++p) store(sums + p * kLanes, all(0));
  };
  const auto flush = [&] {
    for (std::size_t p = 0; p < pairs; ++p)
      products[p] += static_cast<double>(total(load(sums + p * kLanes)));
  };
  for (std::size_t p = 0; p < pairs; ++p) products[p] = 0;
  clear();
  std::size_t unflushed = 0;
  for (std::size_t begin = 0; begin < block.size(); begin += kProductRows) {
    const std::size_t vectors = centre_rows(block, begin, feature, threshold, centre, rows);
    if (unflushed + vectors > kBlockVectors) {
      flush();
      clear();
      unflushed = 0;
    }
    unflushed += vectors;
    for (std::size_t i = 0; i < columns; ++i) {
      const float* u = rows + i * kProductRows;
      float* row_sums = sums + triangle(i) * kLanes;
      std::size_t j = 0;
      for (; j + kColumnsAtOnce <= i + 1; j += kColumnsAtOnce) {
        add_products<kColumnsAtOnce>(u, rows + j * kProductRows, vectors, row_sums + j * kLanes);
      }
      for (; j + 2 <= i + 1; j += 2)
        add_products<2>(u, rows + j * kProductRows, vectors, row_sums + j * kLanes);
      for (; j < i + 1; ++j) add_products<1>(u, rows + j * kProductRows, vectors, row_sums + j * kLanes);
    }
  }
  flush();
}

// Column after column, the one that splits last.
template <class PartitionColumn>
void partition_by_column(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
                         const PartitionColumn& partition_column) {
  float* x = block.column(feature);
  for (std::size_t c = 0; c < block.width(); ++c) {
    if (c != feature) partition_column(x, threshold, block.size(), block.column(c), scratch);
  }
  partition_column(x, threshold, block.size(), x, scratch);
}

// These two are up to each source.
void round_up(const double* from, std::size_t size, float* to);
void partition(const SampleBlock& block, std::uint32_t feature, float threshold, float* scratch,
               std::size_t scratch_size);

constexpr TreeKernels table(const char* name) {
  return {name, round_up, sum_outputs, find_ranges, find_low_sides, partition, low_products};
}
