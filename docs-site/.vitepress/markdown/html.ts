// Texts in HTML.

/** A text as HTML, also in an attribute between double quotes. */
export const html = (text: string) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;')
