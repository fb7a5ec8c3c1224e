// The program's seeded random numbers: SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number
// generators", 2014), and a stream of its own for every ray.

const MASK = (1n << 64n) - 1n;

export class Random {
  private state: bigint;

  constructor(seed: bigint) {
    this.state = seed & MASK;
  }

  next(): bigint {
    this.state = (this.state + 0x9e3779b97f4a7c15n) & MASK;
    let z = this.state;
    z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & MASK;
    z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & MASK;
    return z ^ (z >> 31n);
  }

  /** Uniform in [0, 1), 53 bits. */
  uniform(): number {
    return Number(this.next() >> 11n) * 2 ** -53;
  }

  between(lo: number, hi: number): number {
    return lo + (hi - lo) * this.uniform();
  }
}

/** The stream of ray `index`. */
export function rayRandom(seed: bigint, index: number): Random {
  return new Random(new Random(new Random(seed).next() + BigInt(index)).next());
}
