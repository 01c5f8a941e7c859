// @ts-check
// A password to hand over: drawn here, shown once, changed by its owner.

const ALPHABET = "23456789abcdefghjkmnpqrstvwxyz";
const GROUPS = 4;
const LETTERS = 4;

/** 78 random bits in letters that are not mistaken for each other. */
export function drawPassword() {
  const groups = [];
  for (let group = 0; group < GROUPS; group += 1) {
    let letters = "";
    while (letters.length < LETTERS) {
      const [byte] = crypto.getRandomValues(new Uint8Array(1));
      // Above it some letters would come more often than others.
      if (byte < 8 * ALPHABET.length) letters += ALPHABET[byte % ALPHABET.length];
    }
    groups.push(letters);
  }
  return groups.join("-");
}
