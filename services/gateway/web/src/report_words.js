// What stands around a report, in the report's language; the report itself comes with its words.

export const LANGUAGES = { en: "English", fr: "Français" };

/** Levels are pages of the report; the third one is made from every stride that was recorded. */
export const ALL_STRIDES = "3";

export const REPORT_WORDS = {
  en: {
    reading_level: "Reading level",
    levels: {
      1: "For patient and therapist",
      2: "For specialists",
      3: "All strides",
    },
    languages: "Language",
    pdf: "PDF",
    print: "Print",
    reading: "Reading …",
    nothing: "There is nothing of this kind to show.",
  },
  fr: {
    reading_level: "Niveau de lecture",
    levels: {
      1: "Pour le patient et le thérapeute",
      2: "Pour les spécialistes",
      3: "Tous les cycles",
    },
    languages: "Langue",
    pdf: "PDF",
    print: "Imprimer",
    reading: "Lecture …",
    nothing: "Il n’y a rien de tel à montrer.",
  },
};
