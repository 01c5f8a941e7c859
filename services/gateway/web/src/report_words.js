// What stands around a report, in the report's language; the report itself comes with its words.

export const LANGUAGES = { en: "English", fr: "Français" };

export const REPORT_WORDS = {
  en: {
    levels: "Reading level",
    1: "For patient and therapist",
    2: "For specialists",
    measured: "Measurements and files",
    languages: "Language",
    pdf: "PDF",
    reading: "Reading …",
  },
  fr: {
    levels: "Niveau de lecture",
    1: "Pour le patient et le thérapeute",
    2: "Pour les spécialistes",
    measured: "Mesures et fichiers",
    languages: "Langue",
    pdf: "PDF",
    reading: "Lecture …",
  },
};
