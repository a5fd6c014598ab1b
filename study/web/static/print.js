// The sheet of invitations, on paper or as a PDF.

document.getElementById("print").addEventListener("click", () => window.print());
