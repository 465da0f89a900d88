// Scrolls the side bar to the entry of this page.
const bar = document.querySelector(".sidebar-scroll");
const here = bar?.querySelector(".current-page");
if (here) bar.scrollTop += here.getBoundingClientRect().top - bar.clientHeight / 2;
