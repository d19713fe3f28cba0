// Starts the page: its code is there in compressed form.
import { inflated } from "./inflate.js";

async function load() {
  try {
    const code = await inflated(document.getElementById("code"));
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(code);
    document.body.append(script);
  } catch (error) {
    document.querySelector(".waiting").textContent = `This report cannot be shown by this browser; one of 2023 or later can. (${error.message})`;
    throw error;
  }
}

load();
