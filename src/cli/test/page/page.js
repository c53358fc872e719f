"use strict";
// Everything that is shown is in the page already; this makes it movable. Nothing is fetched.

document.documentElement.classList.add("scripted");

const MODES = ["side", "slider", "flicker", "difference", "heat"];
const FLICKER_MS = 600;
const LARGEST_PIXEL = 64;
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** The channels of an image, of 0 to 255, read when they are first asked for. */
const pixelsOf = (() => {
    const known = new WeakMap();
    return (image) => {
        if (!known.has(image)) {
            const canvas = document.createElement("canvas");
            canvas.width = image.naturalWidth;
            canvas.height = image.naturalHeight;
            const context = canvas.getContext("2d", { willReadFrequently: true, colorSpace: "srgb" });
            context.drawImage(image, 0, 0);
            known.set(image, context.getImageData(0, 0, canvas.width, canvas.height));
        }
        return known.get(image);
    };
})();

/** The pictures of one case: how they are shown, and which part of them. */
class Stage {
    constructor(element) {
        this.element = element;
        this.figures = [...element.querySelectorAll("figure")];
        this.readout = element.querySelector(".readout");
        this.split = element.querySelector(".divide input");
        // A point u of the picture is seen at (u - origin) * zoom, both in sides of the picture.
        this.zoom = 1;
        this.origin = { x: 0, y: 0 };
        this.timer = null;
        this.figures.forEach((figure) => this.prepare(figure));
        this.listen();
        this.show(element.dataset.mode);
        this.divide(50);
        this.place();
    }

    prepare(figure) {
        const view = figure.querySelector(".view");
        const image = figure.querySelector("img");
        view.style.setProperty("--aspect", image.getAttribute("width") / image.getAttribute("height"));
        for (const name of ["marker", "divider"]) {
            const part = document.createElement("div");
            part.className = name;
            view.append(part);
        }
        view.addEventListener("pointermove", (event) => this.point(view, event));
        view.addEventListener("pointerdown", (event) => this.grab(view, event));
        view.addEventListener("pointerleave", () => this.unmark());
        view.addEventListener("wheel", (event) => this.wheel(view, event), { passive: false });
        view.addEventListener("dblclick", () => this.reset());
    }

    listen() {
        const { element } = this;
        for (const button of element.querySelectorAll("button[data-mode]")) {
            button.addEventListener("click", () => this.show(button.dataset.mode));
        }
        const acts = {
            closer: () => this.scale(2, { x: 0.5, y: 0.5 }),
            farther: () => this.scale(0.5, { x: 0.5, y: 0.5 }),
            whole: () => this.reset(),
            pause: () => this.pause(),
        };
        for (const button of element.querySelectorAll("button[data-act]")) {
            button.addEventListener("click", acts[button.dataset.act]);
        }
        this.split.addEventListener("input", () => this.divide(Number(this.split.value)));
        element.addEventListener("keydown", (event) => this.key(event));
    }

    show(mode) {
        this.element.dataset.mode = mode;
        for (const button of this.element.querySelectorAll("button[data-mode]")) {
            button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
        }
        clearInterval(this.timer);
        this.timer = null;
        if (mode === "flicker") {
            this.element.dataset.shown = "golden";
            if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
        }
        this.place();
    }

    play() {
        this.timer = setInterval(() => this.swap(), FLICKER_MS);
    }

    pause() {
        if (this.timer === null) return this.play();
        clearInterval(this.timer);
        this.timer = null;
    }

    swap() {
        this.element.dataset.shown = this.element.dataset.shown === "golden" ? "actual" : "golden";
    }

    /** Left of the line the golden is seen, right of it the picture of this run. */
    divide(percent) {
        this.split.value = percent;
        this.element.style.setProperty("--split", `${clamp(percent, 0, 100)}%`);
    }

    /** Where in a view, in its sides, the pointer is. */
    at(view, event) {
        const box = view.getBoundingClientRect();
        return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
    }

    wheel(view, event) {
        // A page is scrolled by the same wheel: only pictures that were clicked take it.
        if (!event.ctrlKey && !this.element.contains(document.activeElement)) return;
        event.preventDefault();
        this.scale(Math.exp(-event.deltaY / 400), this.at(view, event));
        this.point(view, event);
    }

    scale(factor, at) {
        const widest = Math.max(...this.figures.map((figure) => figure.querySelector("img").naturalWidth), 1);
        const view = this.figures.map((figure) => figure.querySelector(".view").clientWidth).find((width) => width > 0);
        const zoom = clamp(this.zoom * factor, 1, Math.max(1, (LARGEST_PIXEL * widest) / (view || widest)));
        this.origin.x += at.x / this.zoom - at.x / zoom;
        this.origin.y += at.y / this.zoom - at.y / zoom;
        this.zoom = zoom;
        this.place();
    }

    reset() {
        this.zoom = 1;
        this.place();
    }

    place() {
        for (const axis of ["x", "y"]) this.origin[axis] = clamp(this.origin[axis], 0, 1 - 1 / this.zoom);
        const { x, y } = this.origin;
        for (const figure of this.figures) {
            const [view, image] = [figure.querySelector(".view"), figure.querySelector("img")];
            image.style.transform = `scale(${this.zoom}) translate(${-100 * x}%, ${-100 * y}%)`;
            view.classList.toggle("enlarged", view.clientWidth * this.zoom > 1.5 * image.getAttribute("width"));
        }
        this.element.dataset.zoom = this.zoom.toFixed(3);
    }

    grab(view, event) {
        if (event.button !== 0) return;
        this.element.focus({ preventScroll: true });
        event.preventDefault();
        view.setPointerCapture(event.pointerId);
        let last = this.at(view, event);
        const moved = (event) => {
            const now = this.at(view, event);
            if (this.element.dataset.mode === "slider") {
                this.divide(100 * now.x);
            } else {
                this.origin.x -= (now.x - last.x) / this.zoom;
                this.origin.y -= (now.y - last.y) / this.zoom;
                this.place();
                // The pixel was marked where it was before.
                this.point(view, event);
            }
            last = now;
        };
        if (this.element.dataset.mode === "slider") moved(event);
        const release = () => {
            view.removeEventListener("pointermove", moved);
            for (const name of ["pointerup", "pointercancel"]) view.removeEventListener(name, release);
        };
        view.addEventListener("pointermove", moved);
        for (const name of ["pointerup", "pointercancel"]) view.addEventListener(name, release);
    }

    /** Marks the same pixel in every picture and says its values. */
    point(view, event) {
        const at = this.at(view, event);
        const u = { x: this.origin.x + at.x / this.zoom, y: this.origin.y + at.y / this.zoom };
        const values = [];
        let place = "";
        for (const figure of this.figures) {
            const image = figure.querySelector("img");
            const [width, height] = [image.naturalWidth, image.naturalHeight];
            const x = clamp(Math.floor(u.x * width), 0, width - 1);
            const y = clamp(Math.floor(u.y * height), 0, height - 1);
            if (width === 0) continue;
            this.mark(figure.querySelector(".marker"), x / width, y / height, 1 / width, 1 / height);
            const start = 4 * (y * width + x);
            const channels = [...pixelsOf(image).data.slice(start, start + 4)];
            place = `x ${x}, y ${y}`;
            values.push(`${figure.dataset.role} ${channels.join(" ")}`);
        }
        this.readout.textContent = [place, ...values].join("   ");
    }

    mark(marker, x, y, width, height) {
        const percent = (value) => `${100 * this.zoom * value}%`;
        marker.style.left = percent(x - this.origin.x);
        marker.style.top = percent(y - this.origin.y);
        marker.style.width = percent(width);
        marker.style.height = percent(height);
        marker.style.display = "block";
    }

    unmark() {
        for (const figure of this.figures) figure.querySelector(".marker").style.display = "none";
        this.readout.textContent = "";
    }

    key(event) {
        if (event.ctrlKey || event.altKey || event.metaKey || event.target !== this.element) return;
        const step = 0.1 / this.zoom;
        const pan = (x, y) => () => {
            if (this.element.dataset.mode === "slider" && x !== 0) return this.divide(Number(this.split.value) + 2 * Math.sign(x));
            this.origin.x += x;
            this.origin.y += y;
            this.place();
        };
        const acts = {
            "+": () => this.scale(2, { x: 0.5, y: 0.5 }),
            "-": () => this.scale(0.5, { x: 0.5, y: 0.5 }),
            0: () => this.reset(),
            " ": () => this.swap(),
            ArrowLeft: pan(-step, 0),
            ArrowRight: pan(step, 0),
            ArrowUp: pan(0, -step),
            ArrowDown: pan(0, step),
        };
        MODES.forEach((mode, index) => {
            const button = this.element.querySelector(`button[data-mode="${mode}"]`);
            if (button) acts[index + 1] = () => this.show(mode);
        });
        const act = acts[event.key];
        if (act === undefined) return;
        event.preventDefault();
        act();
    }
}

const stages = new WeakSet();
function open(details) {
    const stage = details.querySelector(".stage");
    if (!details.open || !stage || stages.has(stage)) return;
    stages.add(stage);
    new Stage(stage);
}

const cases = [...document.querySelectorAll("details.case")];
for (const details of cases) {
    details.addEventListener("toggle", () => open(details));
    open(details);
}

/** Only cases of the chosen states, with the words that are searched for. */
function filter() {
    const chosen = [...document.querySelectorAll(".filters input[type=checkbox]")].filter((box) => box.checked);
    const states = new Set(chosen.map((box) => box.value));
    const words = document.querySelector(".filters input[type=search]").value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const details of cases) {
        const text = details.querySelector("summary").textContent.toLowerCase();
        details.hidden = !states.has(details.dataset.status) || !words.every((word) => text.includes(word));
    }
}
document.querySelector(".filters").addEventListener("input", filter);
// A browser that goes back to a page fills in what was chosen.
filter();

for (const button of document.querySelectorAll(".copy")) {
    button.addEventListener("click", async () => {
        const code = button.parentElement.querySelector("code");
        getSelection().selectAllChildren(code);
        try {
            await navigator.clipboard.writeText(code.textContent);
            button.textContent = "copied";
        } catch {
            button.textContent = "selected";
        }
    });
}
