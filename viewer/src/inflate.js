// What stands deflated and in base64 in the page.

/** The bytes of an element's text. */
export async function inflated(element) {
  const binary = atob(element.textContent.trim());
  const bytes = Uint8Array.from({ length: binary.length }, (_, i) => binary.charCodeAt(i));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
